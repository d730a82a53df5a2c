//! Finds the local address from which a host would be reached, and whether both are in one network. Sends nothing.

use serde::Serialize;
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use tokio::net::UdpSocket;

/// The route to a host.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Route {
    /// The host.
    pub to: IpAddr,
    /// The local address that would be used.
    pub from: IpAddr,
    /// The network interface with that address; `None` if the system does not report it.
    pub interface: Option<String>,
    /// Prefix length of that address; `None` if the system does not report it.
    pub prefix: Option<u32>,
}

impl Route {
    /// True if the host is in the same network, without a router in between; `None` if the prefix is unknown.
    pub fn is_direct(&self) -> Option<bool> {
        let prefix = self.prefix?;
        match (self.to, self.from) {
            (IpAddr::V4(to), IpAddr::V4(from)) => {
                Some(network(to, prefix) == network(from, prefix))
            }
            // An address of this computer itself.
            (to, from) if to == from => Some(true),
            _ => None,
        }
    }
}

fn network(address: Ipv4Addr, prefix: u32) -> u32 {
    let mask = u32::MAX
        .checked_shl(32_u32.saturating_sub(prefix))
        .unwrap_or(0);
    u32::from(address) & mask
}

/// Queries the system for the route. Connecting a datagram socket sends nothing.
///
/// # Errors
/// A name without address, or no route.
pub async fn route(host: &str, port: u16) -> io::Result<Route> {
    let mut found = tokio::net::lookup_host((host, port)).await?;
    let to = found.next().ok_or(io::ErrorKind::NotFound)?;
    let any: SocketAddr = match to {
        SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
        SocketAddr::V6(_) => (std::net::Ipv6Addr::UNSPECIFIED, 0).into(),
    };
    let socket = UdpSocket::bind(any).await?;
    socket.connect(to).await?;
    let from = socket.local_addr()?.ip();
    let (interface, prefix) = interface_of(from).unzip();
    Ok(Route {
        to: to.ip(),
        from,
        interface,
        prefix: prefix.flatten(),
    })
}

/// The interface that has this address, with its prefix length.
#[cfg(unix)]
fn interface_of(address: IpAddr) -> Option<(String, Option<u32>)> {
    let all = nix::ifaddrs::getifaddrs().ok()?;
    let mut named = all.filter_map(|interface| {
        let own = interface.address.as_ref()?;
        let (own, mask) = match (own.as_sockaddr_in(), own.as_sockaddr_in6()) {
            (Some(own), _) => {
                let mask = interface
                    .netmask
                    .as_ref()
                    .and_then(|mask| mask.as_sockaddr_in());
                let ones = mask.map(|mask| u32::from(mask.ip()).count_ones());
                (IpAddr::V4(own.ip()), ones)
            }
            (None, Some(own)) => (IpAddr::V6(own.ip()), None),
            (None, None) => return None,
        };
        (own == address).then_some((interface.interface_name, mask))
    });
    named.next()
}

#[cfg(not(unix))]
fn interface_of(_address: IpAddr) -> Option<(String, Option<u32>)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_addresses_are_in_one_network_by_their_prefix() {
        for (to, from, prefix, direct) in [
            ("192.168.11.210", "192.168.11.100", Some(24), Some(true)),
            ("192.168.11.210", "192.168.123.5", Some(24), Some(false)),
            ("192.168.11.210", "192.168.123.5", Some(16), Some(true)),
            ("10.0.0.1", "10.0.0.2", None, None),
            ("10.0.0.1", "11.0.0.2", Some(0), Some(true)),
        ] {
            let route = Route {
                to: to.parse().unwrap(),
                from: from.parse().unwrap(),
                interface: None,
                prefix,
            };
            assert_eq!(route.is_direct(), direct, "{to} {from} {prefix:?}");
        }
    }

    #[tokio::test]
    async fn the_way_to_this_computer_is_direct() {
        let route = route("127.0.0.1", 6000).await.unwrap();
        assert_eq!(route.from, IpAddr::V4(Ipv4Addr::LOCALHOST));
        if cfg!(target_os = "linux") {
            assert_eq!(route.interface.as_deref(), Some("lo"));
            assert_eq!(route.is_direct(), Some(true));
        }
    }
}
