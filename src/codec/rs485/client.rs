//! Client half of the framing: encodes requests, decodes replies. The device half is in `device`.

use crate::codec::rs485::framing::{
    self, CALIBRATION_END, FrameDirection, FrameParts, Framer, FramerCounts, Payload, READ_LEN_MAX,
    Rs485Frame, WRITE,
};
use crate::hand::register::SAVE;
use crate::hand::{HandId, RegisterWrite, Span};

/// Builds the request that reads these bytes (manual 2.2.1); `None` for 0 or more than [`READ_LEN_MAX`] bytes.
pub fn encode_read(id: HandId, span: Span) -> Option<Rs485Frame> {
    if span.len == 0 || span.len > READ_LEN_MAX {
        return None;
    }
    let len = u8::try_from(span.len).ok()?;
    let frame = framing::build_short(
        FrameDirection::Request,
        id.get(),
        framing::READ,
        span.address,
        len,
    );
    Some(frame)
}

/// Builds the request that writes these bytes (manual 2.2.2).
pub fn encode_write(id: HandId, write: &RegisterWrite) -> Rs485Frame {
    let frame = framing::build(
        FrameDirection::Request,
        id.get(),
        WRITE,
        write.address(),
        write.bytes(),
    );
    debug_assert!(frame.is_some(), "a write has 1 to 12 bytes");
    frame.unwrap_or_default()
}

/// Reply of a hand. The id is as received: after a change of HAND_ID the acknowledgement may carry the new id.
#[expect(
    clippy::large_enum_variant,
    reason = "the buffer stands inside on purpose: no allocation per frame"
)]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Rs485Reply {
    /// Reply to a read (manual 2.2.1).
    Read {
        /// Id of the hand that replies.
        id: u8,
        /// Address of the first byte.
        address: u16,
        /// 1 to 252 bytes in memory order.
        bytes: Payload,
    },
    /// Acknowledgement of a write (manual 2.2.2), or the late result of SAVE.
    WriteAck {
        /// Id of the hand that replies.
        id: u8,
        /// Address of the first byte.
        address: u16,
        /// 1 according to the manual.
        value: u8,
    },
}

/// Result of a SAVE (manual 2.2.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SaveResult {
    /// 0x00: written to flash.
    Ok,
    /// 0xFF: not written.
    Failed,
    /// A value that the manual does not define.
    Other(u8),
}

impl Rs485Reply {
    fn from_parts(parts: FrameParts) -> Self {
        let (id, address, bytes) = (parts.id, parts.address, parts.data);
        match bytes.first() {
            Some(&value) if parts.command == WRITE => Self::WriteAck { id, address, value },
            _ => Self::Read { id, address, bytes },
        }
    }

    /// Id of the hand that replies.
    pub const fn id(&self) -> u8 {
        match self {
            Self::Read { id, .. } | Self::WriteAck { id, .. } => *id,
        }
    }

    /// Address of the first byte.
    pub const fn address(&self) -> u16 {
        match self {
            Self::Read { address, .. } | Self::WriteAck { address, .. } => *address,
        }
    }

    /// True if this can be the frame that ends a calibration of the force sensors. Only meaningful while one is pending.
    // Manual: silent; the older manual of this family shows `90 EB 01 04 11 02 00 00 18`, about six seconds later.
    pub fn is_calibration_end(&self) -> bool {
        matches!(self, Self::Read { address: CALIBRATION_END, bytes, .. } if bytes.as_slice() == [0])
    }

    /// Returns the result of a SAVE, if this can be the late frame that carries it.
    ///
    /// Only meaningful while a SAVE is pending: a plain read of the SAVE register looks the same. The first acknowledgement (command
    /// 0x12, value 1) is not a result.
    pub fn save_result(&self) -> Option<SaveResult> {
        if self.address() != SAVE.address {
            return None;
        }
        // Manual: the table of 2.2.2 prints command 0x12 for this frame, older manuals show 0x11: both are accepted.
        let value = match self {
            Self::WriteAck { value: 1, .. } => return None,
            Self::WriteAck { value, .. } => *value,
            Self::Read { bytes, .. } => match bytes.as_slice() {
                [value] => *value,
                _ => return None,
            },
        };
        Some(match value {
            0x00 => SaveResult::Ok,
            0xFF => SaveResult::Failed,
            other => SaveResult::Other(other),
        })
    }
}

impl ReplyDecoder {
    /// Returns the oldest whole request seen on the line: our own, echoed by an adapter, or another controller's. A burst is truncated to
    /// the first few.
    pub fn overheard(&mut self) -> Option<Rs485Frame> {
        self.0.overheard()
    }
}

framing::decoder!(
    /// Decodes replies from received bytes. Whole requests (echoes) are skipped and counted.
    ReplyDecoder,
    FrameDirection::Reply,
    Rs485Reply,
    Rs485Reply::from_parts
);
