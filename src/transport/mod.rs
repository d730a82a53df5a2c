//! Wires: endpoints, serial ports, sockets, in-memory pipes. Knows no hand.

pub mod endpoint;
pub mod wire;

pub use endpoint::{Endpoint, EndpointError, SerialLine};
pub use wire::{BoxedWire, Dial, TransportError, Wire};
