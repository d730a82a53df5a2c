//! One frame for display: time, direction, content, fault. Independent of the decoding.

use crate::hand::{Moment, Span};
use crate::record::Direction;
use crate::transport::Endpoint;
use std::time::Duration;

/// Framing on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameFormat {
    /// The private framing (manual 2.2).
    Rs485,
    /// Modbus RTU (manual 2.4).
    Rtu,
    /// Modbus TCP (manual 2.5).
    Tcp,
    /// Linux's `struct can_frame` (manual 2.3).
    Can,
    /// Lines of a serial CAN adapter.
    Slcan,
    /// Packets of the maker's own CAN adapter.
    UsbCan,
}

impl FrameFormat {
    /// Framing of an endpoint; the built-in hand uses RS485.
    pub const fn of(endpoint: &Endpoint) -> Self {
        match endpoint {
            Endpoint::Sim { .. } | Endpoint::Rs485(_) => Self::Rs485,
            Endpoint::Rtu(_) | Endpoint::RtuTcp(_) => Self::Rtu,
            Endpoint::Tcp { .. } => Self::Tcp,
            Endpoint::Can { .. } => Self::Can,
            Endpoint::Slcan { .. } => Self::Slcan,
            Endpoint::UsbCan { .. } => Self::UsbCan,
        }
    }
}

/// Kind of a frame, the same for all protocols.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The wire was opened.
    Opened,
    /// This program closed the wire.
    Closed,
    /// The other side hung up, or the wire broke.
    Broken,
    /// Pieces that were dropped from the ring before they were read.
    Gap,
    /// A read request.
    Read,
    /// A reply with memory.
    ReadReply,
    /// A write request.
    Write,
    /// An acknowledged write.
    WriteReply,
    /// The hand refused.
    Refusal,
    /// The late frame with the result of a SAVE (manual 2.2.2).
    SaveResult,
    /// A command to the CAN adapter itself.
    Adapter,
    /// A message of the CAN adapter or the CAN interface itself.
    AdapterReply,
    /// Not a frame.
    Noise,
}

/// Fault of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum Wrong {
    /// The sum over the frame differs (manual 2.2.1).
    #[error("checksum {got:02X}, should be {want:02X}")]
    Checksum {
        /// Value in the frame.
        got: u8,
        /// Value computed over the frame.
        want: u8,
    },
    /// The CRC over the frame differs (manual 2.4).
    #[error("CRC {got:04X}, should be {want:04X}")]
    Crc {
        /// Value in the frame.
        got: u16,
        /// Value computed over the frame.
        want: u16,
    },
    /// It ended before its own length byte indicates.
    #[error("cut off: {got} bytes{}", of(.want))]
    CutOff {
        /// Number of bytes received.
        got: usize,
        /// Number of bytes expected, if known.
        want: Option<usize>,
    },
    /// A header followed by an impossible length or command.
    #[error("header with impossible length {len} or command")]
    BadHead {
        /// The length byte.
        len: u8,
        /// The command byte.
        command: Option<u8>,
    },
    /// Bytes in which no frame begins.
    #[error("{len} bytes that are not a frame")]
    NoFrame {
        /// Number of bytes.
        len: usize,
    },
    /// Another protocol id than 0 (manual 2.5).
    #[error("protocol id {got}, should be 0: the other side does not speak Modbus TCP")]
    Protocol {
        /// Value in the frame.
        got: u16,
    },
    /// A length field with an impossible value (manual 2.5).
    #[error("length field {got}, possible are 2 to 254")]
    LengthField {
        /// Value in the frame.
        got: u16,
    },
    /// A function that this hand does not support, or with a wrong length.
    #[error("unknown function {function}, or one of the wrong length")]
    Function {
        /// Value in the frame.
        function: u8,
    },
    /// A frame from or to another hand.
    #[error("id {got}, this hand is {want}")]
    ForeignId {
        /// Value in the frame.
        got: u16,
        /// Id of this link's hand.
        want: u16,
    },
    /// A CAN identifier outside this hand's protocol.
    #[error("identifier {id:08X} does not belong to the hand")]
    ForeignCanId {
        /// Value in the frame.
        id: u32,
    },
    /// A received request: an echo of the adapter, or another program's.
    #[error("a request from outside: an echo, or another program on the bus")]
    Echo,
    /// A sent reply, which is never valid.
    #[error("a reply going out")]
    Backwards,
    /// No request matches this reply.
    #[error("unsolicited")]
    NotAsked,
    /// It answers a request that timed out.
    #[error("late: the request was given up {after_ms} ms ago")]
    Late {
        /// Time since the request.
        after_ms: u64,
    },
    /// Fewer or more bytes than requested.
    #[error("{got} bytes of memory, {want} were requested")]
    Amount {
        /// Value in the frame.
        got: u16,
        /// Value in the request.
        want: u16,
    },
    /// Another address than requested.
    #[error("address {got}, {want} was requested")]
    Address {
        /// Value in the frame.
        got: u16,
        /// Value in the request.
        want: u16,
    },
    /// Another number than that of the open request (manual 2.5).
    #[error("transaction {got}, expected {want}")]
    Transaction {
        /// Value in the frame.
        got: u16,
        /// Value in the request.
        want: u16,
    },
    /// The hand refused.
    #[error("refused with code {code}")]
    Refused {
        /// Reason code of the standard.
        code: u8,
    },
    /// The hand did not accept the write: an acknowledgement other than 1.
    #[error("not accepted: acknowledgement {value}, should be 1")]
    NotTaken {
        /// Value in the frame.
        value: u8,
    },
    /// A SAVE that failed (manual 2.2.2).
    #[error("SAVE failed with {value:02X}")]
    NotSaved {
        /// Value in the frame.
        value: u8,
    },
    /// No reply before the next request.
    #[error("no reply")]
    NoReply,
    /// Not a line of a serial adapter.
    #[error("not a line of a serial CAN adapter")]
    Line,
    /// The adapter reported a failure.
    #[error("the adapter reports failure")]
    AdapterFailed,
    /// The CAN controller left the bus.
    #[error("bus-off: the controller left the bus")]
    BusOff,
    /// The CAN controller counted many errors.
    #[error("error-passive: the controller saw many errors")]
    ErrorPassive,
    /// Pieces that were dropped.
    #[error("{pieces} earlier pieces are no longer kept")]
    Forgotten {
        /// Number of pieces.
        pieces: u64,
    },
}

fn of(want: &Option<usize>) -> String {
    want.map(|want| format!(" of {want}")).unwrap_or_default()
}

impl Wrong {
    /// True if the bytes themselves are damaged or not a frame, rather than only out of place.
    pub const fn is_damage(&self) -> bool {
        matches!(
            self,
            Self::Checksum { .. }
                | Self::Crc { .. }
                | Self::CutOff { .. }
                | Self::BadHead { .. }
                | Self::NoFrame { .. }
                | Self::Protocol { .. }
                | Self::LengthField { .. }
                | Self::Function { .. }
                | Self::Line
        )
    }
}

/// One frame, or a change of the wire, which has no bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// Sequence number of the frame on its link, from 1. Never reused.
    pub number: u64,
    /// Time of its last byte.
    pub at: Moment,
    /// Direction of the frame.
    pub direction: Direction,
    /// Framing on the wire.
    pub form: FrameFormat,
    /// All bytes on the wire.
    pub bytes: Box<[u8]>,
    /// Request, reply, event of the wire, or noise.
    pub kind: Kind,
    /// The hand that is addressed, or that answers.
    pub hand: Option<u16>,
    /// The memory range. In a reply without address, that of the request it answers.
    pub span: Option<Span>,
    /// Bytes of the hand's memory that it carries, in memory order.
    pub memory: Box<[u8]>,
    /// Fault of the frame.
    pub wrong: Option<Wrong>,
    /// Time from the end of the request to the end of this reply.
    pub took: Option<Duration>,
}

impl Frame {
    /// True if it belongs to regular polling and has no fault.
    pub const fn is_polling(&self) -> bool {
        matches!(self.kind, Kind::Read | Kind::ReadReply) && self.wrong.is_none()
    }

    /// The bytes in hex, two digits each, separated by spaces.
    pub fn hex(&self) -> String {
        hex(&self.bytes)
    }
}

/// Bytes in hex, two digits each, separated by spaces.
pub fn hex(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
    let digit = |half: u8| char::from(DIGITS.get(usize::from(half)).copied().unwrap_or(b'?'));
    let mut text = String::with_capacity(bytes.len() * 3);
    for byte in bytes {
        if !text.is_empty() {
            text.push(' ');
        }
        text.push(digit(byte >> 4));
        text.push(digit(byte & 15));
    }
    text
}
