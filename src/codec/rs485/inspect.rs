//! What stands at the beginning of some bytes, good or wrong, for those who show frames. Acting on them is the decoders'.

use crate::codec::rs485::framing::{self, Payload, Scan, WRITE};

pub use crate::codec::rs485::framing::Way;

/// A frame's parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parts {
    /// The hand that is meant or that answers.
    pub id: u8,
    /// True for command 0x12, false for 0x11.
    pub writes: bool,
    /// First byte's address.
    pub address: u16,
    /// 1 to 252 bytes of data; the length wanted in a read request.
    pub data: Payload,
}

/// What the bytes begin with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// A good frame of so many bytes.
    Frame(Way, usize),
    /// A frame of so many bytes whose checksum is wrong.
    BadSum {
        /// Which way it goes.
        way: Way,
        /// Bytes, header to checksum.
        len: usize,
        /// The checksum that was sent.
        got: u8,
        /// The checksum of what was sent.
        want: u8,
    },
    /// The beginning of a frame; its length if that is known by now.
    Open(Option<usize>),
    /// A header, but a length or command that no frame has.
    BadHead {
        /// The length byte.
        len: u8,
        /// The command byte, if it is there.
        command: Option<u8>,
    },
    /// No header.
    Nothing,
}

/// Looks at the beginning of some bytes. None of them is [`Found::Open`].
#[must_use]
pub fn inspect(bytes: &[u8]) -> Found {
    match framing::scan(bytes) {
        Scan::Frame(way, len) => Found::Frame(way, len),
        Scan::NeedMore => Found::Open(bytes.get(3).map(|len| framing::total(*len))),
        Scan::BadSum(way, len) => match bytes.get(2..len) {
            Some([body @ .., got]) => Found::BadSum {
                way,
                len,
                got: *got,
                want: framing::checksum(body),
            },
            _ => Found::Nothing,
        },
        Scan::Bad => match bytes {
            [0xEB, 0x90, _, len, rest @ ..] | [0x90, 0xEB, _, len, rest @ ..] => Found::BadHead {
                len: *len,
                command: rest.first().copied(),
            },
            _ => Found::Nothing,
        },
    }
}

/// The parts of a whole frame, whatever its checksum says; `None` if it is too short.
#[must_use]
pub fn parts(frame: &[u8]) -> Option<Parts> {
    let parts = framing::parts(frame)?;
    Some(Parts {
        id: parts.id,
        writes: parts.command == WRITE,
        address: parts.address,
        data: parts.data,
    })
}
