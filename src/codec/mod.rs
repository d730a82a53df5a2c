//! Bytes on a wire to register operations and back, for both sides of the conversation. No IO, no clock.
#![warn(missing_docs)]

pub mod can;
pub mod mbap;
pub mod modbus;
pub mod modbus_rtu;
pub mod pdu;
pub mod rs485;
pub mod slcan;
pub mod usbcan;

/// What a decoder met apart from good replies, lines or packets. Counts only grow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoiseCounts {
    /// Replies or packets whose check was wrong.
    pub checksum_errors: u64,
    /// Runs of bytes that had to be skipped to find the next good one.
    pub resyncs: u64,
    /// Bytes skipped because no frame began with them.
    pub skipped_bytes: u64,
}
