//! Linux's CAN sockets as a wire: each 16 bytes are one `struct can_frame`. Does not interpret frames.

use crate::system::SystemError;
use crate::transport::wire::TransportError;
use socketcan::tokio::CanSocket;
use socketcan::{CanAddr, CanFilter, SocketOptions as _};
use std::io;
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Interval, interval};

/// Linux marks 29-bit identifiers with this bit, and remote frames with the next.
const EXTENDED: u32 = 0x8000_0000;
const REMOTE: u32 = 0x4000_0000;
/// The part of an identifier that contains the node id: its low 14 bits.
const NODE: u32 = 0x3FFF;

/// Interval at which the interface is checked, because a listener is not woken when it goes down.
const POLL_INTERVAL: Duration = Duration::from_millis(500);

// Error codes of the kernel.
const ENXIO: i32 = 6;
const ENODEV: i32 = 19;
const EPROTONOSUPPORT: i32 = 93;
const EAFNOSUPPORT: i32 = 97;
const ENETDOWN: i32 = 100;
const ENOBUFS: i32 = 105;

/// An open CAN interface.
#[derive(Debug)]
pub struct CanWire {
    socket: CanSocket,
    place: String,
    /// Timer for the next check that the interface is still up.
    look: Interval,
}

/// Opens an interface. It receives data frames with a 29-bit identifier, of one node if given, and error frames; never
/// what this socket sent itself. Must be called within a tokio runtime.
///
/// # Errors
/// `NoInterface`, `NotCan`, `InterfaceDown`, `NoCan`, or `Io` with the system's message.
pub fn open(interface: &str, node: Option<u32>) -> Result<CanWire, TransportError> {
    let failed = |error: io::Error| can_error(interface, &error);
    let address = CanAddr::from_iface(interface).map_err(failed)?;
    let socket = CanSocket::open_addr(&address).map_err(failed)?;
    socket.set_recv_own_msgs(false).map_err(failed)?;
    socket.set_error_filter_accept_all().map_err(failed)?;
    let mask = EXTENDED | REMOTE | node.map_or(0, |_| NODE);
    let filter = CanFilter::new(EXTENDED | node.unwrap_or_default(), mask);
    socket.set_filters(&[filter]).map_err(failed)?;
    refuse_if_down(interface)?;
    Ok(CanWire {
        socket,
        place: interface.into(),
        look: interval(POLL_INTERVAL),
    })
}

/// The existing CAN interfaces, up or down, by name.
pub fn interfaces() -> Vec<String> {
    /// The kernel's type of a CAN interface (ARPHRD_CAN).
    const CAN: &str = "280";
    let Ok(all) = std::fs::read_dir("/sys/class/net") else {
        return Vec::new();
    };
    let mut names: Vec<String> = all
        .flatten()
        .filter(|entry| {
            let kind = std::fs::read_to_string(entry.path().join("type"));
            kind.is_ok_and(|kind| kind.trim() == CAN)
        })
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    names
}

/// The kernel opens an interface that is down, and fails only when something is sent.
fn refuse_if_down(interface: &str) -> Result<(), TransportError> {
    const UP: u32 = 1;
    let flags = std::fs::read_to_string(format!("/sys/class/net/{interface}/flags"));
    let flags = flags
        .ok()
        .and_then(|text| u32::from_str_radix(text.trim().trim_start_matches("0x"), 16).ok());
    match flags {
        None if std::path::Path::new("/sys/class/net/lo").exists() => {
            Err(TransportError::NoInterface {
                place: interface.into(),
            })
        }
        Some(flags) if flags & UP == 0 => Err(TransportError::InterfaceDown {
            place: interface.into(),
        }),
        // If it cannot be read, sending will fail.
        _ => Ok(()),
    }
}

fn can_error(interface: &str, error: &io::Error) -> TransportError {
    let place = interface.to_owned();
    match error.raw_os_error() {
        Some(ENODEV)
            if std::path::Path::new("/sys/class/net")
                .join(interface)
                .exists() =>
        {
            TransportError::NotCan { place }
        }
        Some(ENODEV | ENXIO) => TransportError::NoInterface { place },
        Some(ENETDOWN) => TransportError::InterfaceDown { place },
        Some(EAFNOSUPPORT | EPROTONOSUPPORT) => TransportError::NoCan { place },
        Some(ENOBUFS) => TransportError::QueueFull { place },
        _ => TransportError::Io {
            place,
            failure: SystemError::from(error).into(),
        },
    }
}

impl CanWire {
    /// Converts the system's errors to [`TransportError`], which the link extracts again.
    fn worded<T>(&self, polled: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        polled.map_err(|error| io::Error::other(can_error(&self.place, &error)))
    }
}

impl AsyncRead for CanWire {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let polled = Pin::new(&mut self.socket).poll_read(cx, buf);
        if polled.is_pending() {
            while self.look.poll_tick(cx).is_ready() {
                refuse_if_down(&self.place).map_err(io::Error::other)?;
            }
        }
        self.worded(polled)
    }
}

impl AsyncWrite for CanWire {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &[u8],
    ) -> Poll<io::Result<usize>> {
        let polled = Pin::new(&mut self.socket).poll_write(cx, buf);
        self.worded(polled)
    }

    fn poll_flush(self: Pin<&mut Self>, _cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernels_errors_have_their_own_words() {
        let of = |code| can_error("can9", &io::Error::from_raw_os_error(code));
        let place = || "can9".to_owned();
        for (code, wanted) in [
            (ENODEV, TransportError::NoInterface { place: place() }),
            (ENETDOWN, TransportError::InterfaceDown { place: place() }),
            (EAFNOSUPPORT, TransportError::NoCan { place: place() }),
            (ENOBUFS, TransportError::QueueFull { place: place() }),
        ] {
            assert_eq!(of(code), wanted);
            assert!(wanted.to_string().contains("can9"), "{wanted}");
        }
        assert!(matches!(of(5), TransportError::Io { .. }));
    }

    #[tokio::test]
    async fn an_interface_of_another_kind_is_told() {
        let error = open("lo", None).unwrap_err();
        let place = "lo".to_owned();
        let known = [
            TransportError::NotCan {
                place: place.clone(),
            },
            TransportError::NoCan { place },
        ];
        assert!(known.contains(&error), "{error:?}");
    }
}
