//! The interface of every wire: a stream of bytes both ways, and how to open one. Independent of hand and protocol.

use crate::system::SystemError;
use crate::transport::endpoint::Endpoint;
use crate::transport::found::PortFound;
use crate::transport::permission::Remedy;
use futures::future::BoxFuture;
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite};

/// A stream of bytes both ways. A read of zero bytes means that the other side hung up.
pub trait Wire: AsyncRead + AsyncWrite + Send + Unpin + 'static {}

impl<T: AsyncRead + AsyncWrite + Send + Unpin + 'static> Wire for T {}

/// A wire of any kind.
pub type BoxedWire = Box<dyn Wire>;

/// Opens wires. The link receives an implementation, so that tests and the simulated hand can replace the system's wires.
pub trait Dial: Send + Sync + 'static {
    /// Opens the wire of this endpoint. Must be cancellable by dropping.
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>>;

    /// Delay before this attempt, the first being 1, after a wire was lost or did not open; `None` for the default.
    fn retry_delay(&self, _attempt: u32) -> Option<Duration> {
        None
    }

    /// The serial ports that the system lists now, used to find an adapter under another name. Empty if wires are not
    /// the system's. Must be cancellable by dropping.
    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        Box::pin(std::future::ready(Vec::new()))
    }

    /// The CAN interfaces that the system lists now, by name. Must be cancellable by dropping.
    fn interfaces(&self) -> BoxFuture<'static, Vec<String>> {
        Box::pin(std::future::ready(Vec::new()))
    }
}

/// Advice that lists the alternative ports.
fn instead(alike: &[String]) -> String {
    if alike.is_empty() {
        return ": plug it in again".into();
    }
    format!(
        ": plug it in again, or connect to {} if that is the one you mean",
        alike.join(" or ")
    )
}

/// Reason why a wire could not be opened, or broke. Each kind has its own message for the user.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize)]
pub enum TransportError {
    /// The port or interface does not exist.
    #[error("{place} is not there: plug the adapter in, or choose another port")]
    Missing {
        /// Port, interface or address.
        place: String,
    },
    /// It is a folder or an ordinary file.
    #[error("{place} is not a serial port: choose the device of the adapter, such as /dev/ttyUSB0")]
    NotAPort {
        /// The given path.
        place: String,
    },
    /// The user lacks permission to open it.
    #[error("no permission to open {place}: {remedy}")]
    Permission {
        /// Port or interface.
        place: String,
        /// Measure that changes it.
        remedy: Remedy,
    },
    /// The adapter used before is unplugged, and the present one may be another.
    #[error("the USB adapter of {place} is unplugged{}", instead(.alike))]
    Away {
        /// Port as requested.
        place: String,
        /// Ports of indistinguishable adapters, or of one that took its name.
        alike: Vec<String>,
    },
    /// Another program has it open.
    #[error(
        "{place} is in use by {}: close that program, then connect again",
        .holder.as_deref().unwrap_or("another program")
    )]
    Busy {
        /// Port.
        place: String,
        /// Name and process id of that program; `None` if the system does not report it.
        holder: Option<String>,
    },
    /// A host that rejects the connection: no program listens on the port.
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
        /// Time waited, in milliseconds.
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
    /// This kind of link is not a system wire: the built-in hand, if the dialler does not provide one.
    #[error(
        "'{kind}:' is not reached over a wire of this system: name a port, an address or an interface"
    )]
    Unsupported {
        /// The kind of link.
        kind: String,
    },
    /// No such CAN interface.
    #[error(
        "there is no CAN interface {place}: plug the adapter in; 'ip link show type can' lists what is there"
    )]
    NoInterface {
        /// Interface.
        place: String,
    },
    /// A network interface of another kind.
    #[error(
        "{place} is not a CAN interface: choose one that 'ip link show type can' lists, such as can0"
    )]
    NotCan {
        /// Interface.
        place: String,
    },
    /// The CAN interface is down.
    #[error(
        "the CAN interface {place} is down: run 'sudo ip link set {place} up type can bitrate 1000000'"
    )]
    InterfaceDown {
        /// Interface.
        place: String,
    },
    /// The system has no CAN sockets.
    #[error(
        "{place} cannot be opened: the kernel of this system has no CAN; use an adapter with slcan: instead"
    )]
    NoCan {
        /// Interface.
        place: String,
    },
    /// CAN sockets exist only on Linux.
    #[error("'can:' links need Linux: use an adapter with slcan: here")]
    LinuxOnly,
    /// Queued frames cannot be sent: no node acknowledges them.
    #[error(
        "{place} cannot send, its frames stay in the queue: no other node on the CAN bus acknowledges them; check cable, termination, bit rate and the hand's power"
    )]
    QueueFull {
        /// Interface or port.
        place: String,
    },
    /// The controller left the bus after too many errors.
    #[error(
        "{place} is bus-off, too many errors on the CAN bus: check bit rate, cable and termination, then run 'sudo ip link set {place} down' and up again"
    )]
    BusOff {
        /// Interface.
        place: String,
    },
    /// The controller counted many errors, and requests get no reply.
    #[error(
        "{place} is error-passive and nothing answers: most likely the bit rate is wrong, or there is no other node on the CAN bus; check bit rate, cable, termination and the hand's power"
    )]
    ErrorPassive {
        /// Interface.
        place: String,
    },
    /// The adapter rejects the bit rate.
    #[error("the CAN adapter on {place} refused {bitrate} bit/s: choose another bit rate")]
    BitrateRefused {
        /// Port.
        place: String,
        /// Bits per second.
        bitrate: u32,
    },
    /// Any other failure.
    #[error("{place} failed: {failure}")]
    Io {
        /// Port or address.
        place: String,
        /// The failure.
        #[serde(rename = "message")]
        failure: WireFailure,
    },
}

/// Failure of a wire for which [`TransportError`] has no advice. In JSON and in recordings it is only its message.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(from = "String", into = "String")]
pub enum WireFailure {
    /// The system's error.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The other side violated the protocol; the library's message.
    #[error("{0}")]
    Protocol(String),
    /// The built-in hand has no such scenario; its own message.
    #[error("{0}")]
    NoScenario(String),
    /// The built-in hand cannot have this body; the message about the file.
    #[error("{0}")]
    NoBody(String),
    /// The built-in hand cannot hold this object; the message about it.
    #[error("{0}")]
    NoObject(String),
    /// The CAN adapter reports that it could not open its channel.
    #[error("the CAN adapter could not join the bus")]
    OffBus,
    /// The message as read from JSON or a recording.
    #[error("{0}")]
    Recorded(String),
}

impl From<WireFailure> for String {
    fn from(failure: WireFailure) -> Self {
        failure.to_string()
    }
}

impl From<String> for WireFailure {
    fn from(words: String) -> Self {
        Self::Recorded(words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_its_words_in_json() {
        let error = |failure| TransportError::Io {
            place: "/dev/x".into(),
            failure,
        };
        let denied = SystemError::from(std::io::Error::from_raw_os_error(13));
        let words = denied.to_string();
        let json = serde_json::to_value(error(denied.into())).unwrap();
        let expected = serde_json::json!({"Io": {"place": "/dev/x", "message": words}});
        assert_eq!(json, expected);
        let read: TransportError = serde_json::from_value(json).unwrap();
        assert_eq!(read, error(WireFailure::Recorded(words)));
    }
}
