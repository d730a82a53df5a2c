//! Wires: endpoints, serial ports, sockets, in-memory pipes. Independent of the hand.

#[cfg(target_os = "linux")]
pub mod can;
pub mod can_facts;
pub mod dds;
pub mod dial;
pub mod endpoint;
pub(crate) mod found;
#[cfg(target_os = "linux")]
mod openers;
pub mod paced;
pub mod permission;
pub mod pipe;
#[cfg(unix)]
pub mod pty;
pub mod serial;
pub mod tcp;
pub mod wire;

pub use crate::transport::endpoint::route::{Route, route};
pub use crate::transport::permission::Remedy;
pub use crate::transport::serial::adapter::{Adapter, Whereabouts, is_same_port};
pub use crate::transport::serial::port_facts::{PortFacts, port_facts};
pub use crate::transport::serial::sysfs::Sysfs;
pub use crate::transport::serial::timer::Timer;
pub use dial::SystemDial;
pub use endpoint::{Endpoint, EndpointError, SerialLine};
pub use found::{PortFound, UsbFound};
pub use paced::{LinePace, paced};
pub use pipe::{Pipe, pair};
#[cfg(unix)]
pub use pty::PtyLink;
pub use serial::ports;
pub use wire::{BoxedWire, Dial, TransportError, Wire, WireFailure};
