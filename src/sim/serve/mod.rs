//! Servers that put the simulated hand on wires and sockets. They own the clock; the hand does not.

pub mod can;
pub mod hands;
mod modbus;
pub mod modbus_rtu;
pub mod modbus_tcp;
#[cfg(unix)]
pub mod pty;
pub mod rs485;
pub mod shared;
pub mod slcan;
pub mod usbcan;

pub use hands::SimHands;
pub use shared::SharedHand;
