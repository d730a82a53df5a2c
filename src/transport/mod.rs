//! Wires: endpoints, serial ports, sockets, in-memory pipes. Knows no hand.

pub mod adapter;
#[cfg(target_os = "linux")]
pub mod can;
#[cfg(target_os = "linux")]
pub mod can_facts;
pub mod dial;
pub mod endpoint;
mod endpoint_error;
pub mod faulty;
mod holder;
pub mod paced;
pub mod packing;
pub mod permission;
pub mod pipe;
pub mod port_facts;
#[cfg(unix)]
pub mod pty;
pub mod route;
pub mod serial;
pub mod sysfs;
pub mod tcp;
pub mod timer;
pub mod wire;

pub use adapter::{Adapter, Whereabouts, is_same_port};
pub use dial::SystemDial;
pub use endpoint::{Endpoint, EndpointError, SerialLine};
pub use faulty::{FaultCounts, FaultOdds, FaultPlan, FaultSwitch, Pace, faulty_pair};
pub use paced::{LinePace, paced};
pub use packing::{NoPacking, Packing};
pub use permission::Remedy;
pub use pipe::{Pipe, pair};
pub use port_facts::{PortFacts, port_facts};
#[cfg(unix)]
pub use pty::PtyLink;
pub use route::{Route, route};
pub use serial::{PortFound, UsbFound, ports};
pub use sysfs::Sysfs;
pub use timer::Timer;
pub use wire::{BoxedWire, Dial, TransportError, Wire};
