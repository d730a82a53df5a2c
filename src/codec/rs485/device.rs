//! Device half of the framing, for the simulated hand: decodes requests, encodes replies. The client half is in `client`.

use crate::codec::rs485::framing::{
    self, CALIBRATION_END, FrameDirection, FrameParts, Framer, FramerCounts, Payload, READ,
    Rs485Frame, WRITE,
};
use crate::hand::Span;
use crate::hand::register::SAVE;

/// Request received by a hand.
#[expect(
    clippy::large_enum_variant,
    reason = "the buffer stands inside on purpose: no allocation per frame"
)]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Rs485Request {
    /// Read these bytes (manual 2.2.1). The length is as received: 0 and 253 to 255 cannot be answered.
    Read {
        /// Id of the addressed hand.
        id: u8,
        /// Requested bytes.
        span: Span,
    },
    /// Write these bytes (manual 2.2.2).
    Write {
        /// Id of the addressed hand.
        id: u8,
        /// Address of the first byte.
        address: u16,
        /// 1 to 252 bytes in memory order.
        bytes: Payload,
    },
}

impl Rs485Request {
    fn from_parts(parts: FrameParts) -> Self {
        let (id, address, bytes) = (parts.id, parts.address, parts.data);
        match bytes.first() {
            Some(&len) if parts.command == READ => Self::Read {
                id,
                span: Span::new(address, u16::from(len)),
            },
            _ => Self::Write { id, address, bytes },
        }
    }
}

framing::decoder!(
    /// Decodes requests from received bytes. Whole replies (of other hands on the bus) are skipped and counted.
    RequestDecoder,
    FrameDirection::Request,
    Rs485Request,
    Rs485Request::from_parts
);

/// Builds the reply to a read (manual 2.2.1); `None` unless there are 1 to 252 bytes.
pub fn encode_read_reply(id: u8, address: u16, bytes: &[u8]) -> Option<Rs485Frame> {
    framing::build(FrameDirection::Reply, id, READ, address, bytes)
}

/// Builds the acknowledgement of a write (manual 2.2.2); the manual's value is 1.
pub fn encode_write_ack(id: u8, address: u16, value: u8) -> Rs485Frame {
    framing::build_short(FrameDirection::Reply, id, WRITE, address, value)
}

/// Builds the late frame that reports the end of a force-sensor calibration.
pub fn encode_calibration_end(id: u8) -> Rs485Frame {
    framing::build_short(FrameDirection::Reply, id, READ, CALIBRATION_END, 0)
}

/// Builds the late frame that carries the result of a SAVE (manual 2.2.2), with command byte 0x11 or 0x12.
pub fn encode_save_result(id: u8, command: u8, ok: bool) -> Rs485Frame {
    let value = if ok { 0x00 } else { 0xFF };
    framing::build_short(FrameDirection::Reply, id, command, SAVE.address, value)
}
