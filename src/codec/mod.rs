//! Bytes on a wire to register operations and back, for both sides of the conversation. No IO, no clock.

pub mod can;
pub mod mbap;
pub mod modbus;
pub mod modbus_rtu;
pub mod pdu;
pub mod rs485;
pub mod slcan;
pub mod usbcan;

/// What the decoder of a CAN adapter met apart from good lines or packets. Counts only grow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoiseCounts {
    /// Packets whose sum was wrong.
    pub checksum_errors: u64,
    /// Runs of bytes that had to be skipped to find the next line or packet.
    pub resyncs: u64,
    /// Bytes skipped.
    pub skipped_bytes: u64,
}
