//! What every wire is: a stream of bytes both ways, and how one is opened. No hand, no protocol.

use crate::transport::endpoint::Endpoint;
use futures::future::BoxFuture;
use tokio::io::{AsyncRead, AsyncWrite};

/// A stream of bytes both ways. A read of zero bytes means that the other side hung up.
pub trait Wire: AsyncRead + AsyncWrite + Send + Unpin + 'static {}

impl<T: AsyncRead + AsyncWrite + Send + Unpin + 'static> Wire for T {}

/// A wire of any kind.
pub type BoxedWire = Box<dyn Wire>;

/// Opens wires. The link is given one, so that tests and the simulated hand can stand behind it.
pub trait Dial: Send + Sync + 'static {
    /// Opens the wire of this endpoint. Must be cancellable by dropping.
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>>;
}

/// Why a wire could not be opened, or broke. Each kind has its own words for a person.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TransportError {
    /// The port or interface is not there.
    #[error("{place} is not there: plug the adapter in, or choose another port")]
    Missing {
        /// Port, interface or address.
        place: String,
    },
    /// It is a folder or an ordinary file.
    #[error("{place} is not a serial port: choose the device of the adapter, such as /dev/ttyUSB0")]
    NotAPort {
        /// What was named.
        place: String,
    },
    /// The system does not let this person open it.
    #[error(
        "no permission to open {place}: run 'sudo usermod -aG dialout $USER', then log out and in again"
    )]
    Permission {
        /// Port or interface.
        place: String,
    },
    /// Another program holds it.
    #[error(
        "{place} is in use by {}: close that program, then connect again",
        .holder.as_deref().unwrap_or("another program")
    )]
    Busy {
        /// Port.
        place: String,
        /// Name and process id of that program, where the system tells.
        holder: Option<String>,
    },
    /// A host that answers "nobody listens here".
    #[error(
        "{place} refused the connection: the host is there, but nothing listens on this port; the hand's own port is 6000"
    )]
    Refused {
        /// Address and port.
        place: String,
    },
    /// A host that does not answer.
    #[error(
        "{place} did not answer within {after_ms} ms: check power, cable and address, and that this computer has an address in the same network"
    )]
    Silent {
        /// Address and port, or serial port.
        place: String,
        /// How long was waited.
        after_ms: u64,
    },
    /// A name without address.
    #[error(
        "the name {place} could not be resolved: check the spelling, or use the address in numbers"
    )]
    Name {
        /// Host name.
        place: String,
    },
    /// The other side hung up: unplugged adapter, closed socket.
    #[error("{place} hung up: the adapter was unplugged, or the other side closed the connection")]
    HungUp {
        /// Port or address.
        place: String,
    },
    /// This kind of link is not in this version or on this system.
    #[error("'{kind}:' links are not in this version yet: use rs485:, rtu: or tcp:")]
    Unsupported {
        /// The kind of link.
        kind: String,
    },
    /// Anything else the system said.
    #[error("{place} failed: {message}")]
    Io {
        /// Port or address.
        place: String,
        /// The system's words.
        message: String,
    },
}
