//! Bytes on a wire to register operations and back, for both sides of the conversation. No IO, no clock.

pub mod can;
pub mod mbap;
pub mod modbus;
pub mod modbus_rtu;
pub mod pdu;
pub mod rs485;
pub mod slcan;
pub mod usbcan;
