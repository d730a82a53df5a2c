//! The sockets of a participant, all at one address, with the ports that RTPS assigns to a domain (DDSI-RTPS 2.5, 9.6.2.3).

use socket2::{Domain, Protocol, SockAddr, Socket, Type};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::thread;
use std::time::Duration;

/// Multicast group for announcements.
const GROUP: Ipv4Addr = Ipv4Addr::new(239, 255, 0, 1);
const FIRST_PORT: u16 = 7400;
const PORTS_OF_DOMAIN: u16 = 250;
const FIRST_OWN_PORT: u16 = 10;
/// Maximum participants per address within the domain's ports.
const PARTICIPANTS: u16 = 120;
/// Number of participants at this address that are announced to by unicast, for those that do not receive multicast.
const NEIGHBOURS: u16 = 10;
/// Receive timeout, after which a thread checks whether it should end.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
pub(super) const DATAGRAM_MAX: usize = 65_535;

/// The sockets: of the group, of announcements, of messages.
pub(super) struct Sockets {
    all: [UdpSocket; Self::COUNT],
    domain: u16,
    announcements: SocketAddrV4,
    messages: SocketAddrV4,
}

impl Sockets {
    pub(super) const COUNT: usize = 3;

    /// Listens at this address and nowhere else.
    ///
    /// # Errors
    /// The system's error if no pair of ports is free, or the group cannot be joined there.
    pub(super) fn open(address: Ipv4Addr, domain: u16) -> io::Result<Self> {
        let group = group(address, first_port(domain))?;
        let mut failure = io::ErrorKind::AddrInUse.into();
        for number in 0..PARTICIPANTS {
            let port = own_port(domain, number);
            let (announcements, messages) = (
                SocketAddrV4::new(address, port),
                SocketAddrV4::new(address, port + 1),
            );
            let pair = UdpSocket::bind(announcements)
                .and_then(|first| Ok((first, UdpSocket::bind(messages)?)));
            match pair {
                Ok((first, second)) => {
                    let all = [group, first, second];
                    for socket in &all {
                        socket.set_read_timeout(Some(POLL_INTERVAL))?;
                    }
                    let [_, first, _] = &all;
                    let sending = socket2::SockRef::from(first);
                    sending.set_multicast_if_v4(&address)?;
                    return Ok(Self {
                        all,
                        domain,
                        announcements,
                        messages,
                    });
                }
                Err(error) => failure = error,
            }
        }
        Err(failure)
    }

    pub(super) const fn announcements_at(&self) -> SocketAddrV4 {
        self.announcements
    }

    pub(super) const fn messages_at(&self) -> SocketAddrV4 {
        self.messages
    }

    /// Destinations of announcements: the group, and the ports at this address for participants that do not receive multicast.
    pub(super) fn everyone(&self) -> Vec<SocketAddrV4> {
        let group = SocketAddrV4::new(GROUP, first_port(self.domain));
        let ports = (0..NEIGHBOURS).map(|number| own_port(self.domain, number));
        let neighbours = ports.map(|port| SocketAddrV4::new(*self.announcements.ip(), port));
        let others = neighbours.filter(|place| *place != self.announcements);
        std::iter::once(group).chain(others).collect()
    }

    /// Sends a datagram; true if it was sent.
    pub(super) fn send(&self, datagram: &[u8], place: SocketAddrV4) -> bool {
        let [_, announcements, _] = &self.all;
        announcements.send_to(datagram, place).is_ok()
    }

    /// Waits for a datagram until the timeout.
    pub(super) fn receive(
        &self,
        nth: usize,
        buffer: &mut [u8; DATAGRAM_MAX],
        take: impl FnOnce(&[u8], Ipv4Addr),
    ) {
        let Some(socket) = self.all.get(nth) else {
            return thread::sleep(POLL_INTERVAL);
        };
        match socket.recv_from(buffer) {
            Ok((len, SocketAddr::V4(source))) => {
                take(buffer.get(..len).unwrap_or_default(), *source.ip());
            }
            Ok(_) => {}
            Err(error) if is_waiting(&error) => {}
            // A socket that fails each time must not keep a core busy.
            Err(_) => thread::sleep(POLL_INTERVAL),
        }
    }
}

fn is_waiting(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    [Interrupted, TimedOut, WouldBlock].contains(&error.kind())
}

const fn first_port(domain: u16) -> u16 {
    FIRST_PORT + PORTS_OF_DOMAIN * domain
}

const fn own_port(domain: u16, number: u16) -> u16 {
    first_port(domain) + FIRST_OWN_PORT + 2 * number
}

/// The socket for multicast datagrams that reach this address.
fn group(address: Ipv4Addr, port: u16) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, Some(Protocol::UDP))?;
    // Every participant of this computer binds this port.
    socket.set_reuse_address(true)?;
    #[cfg(unix)]
    socket.set_reuse_port(true)?;
    // Windows cannot bind to a group.
    let at = if cfg!(windows) { address } else { GROUP };
    socket.bind(&SockAddr::from(SocketAddrV4::new(at, port)))?;
    socket.join_multicast_v4(&GROUP, &address)?;
    #[cfg(target_os = "linux")]
    socket.set_multicast_all_v4(false)?;
    Ok(socket.into())
}
