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

/// Errors that a decoder met between good replies, lines or packets. Counters never decrease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoiseCounts {
    /// Replies or packets with a wrong checksum.
    pub checksum_errors: u64,
    /// Runs of bytes skipped to find the next good frame.
    pub resyncs: u64,
    /// Skipped bytes.
    pub skipped_bytes: u64,
}
