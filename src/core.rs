//! The FTP series tactile dexterous hand: the device, its wires, and all operations on it, without a window. `handscope` re-exports
//! these modules, and its documentation has the map.

pub mod checkup;
pub mod codec;
pub mod exhibit;
#[cfg(test)]
mod fake;
pub mod hand;
pub mod history;
pub mod inputs;
pub mod link;
pub mod manual;
pub mod motion;
pub mod params;
pub mod poses;
pub mod printable;
pub mod record;
pub mod share;
pub mod sim;
#[cfg(test)]
#[path = "../tests/it/setup/soak.rs"]
mod soak;
pub mod store;
pub mod system;
pub mod tasks;
pub mod transport;
pub mod trials;
