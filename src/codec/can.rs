//! CAN frames of manual 2.3: identifiers, pieces of at most 8 bytes, and Linux's 16-byte form of a frame. No bus, no clock.

use crate::hand::register::TOUCH;
use crate::hand::{RegisterWrite, Span};
use arrayvec::ArrayVec;

/// Maximum number of data bytes in one frame.
pub const PIECE_MAX: u16 = 8;
/// Largest id of a hand: 14 bits (manual 2.3).
pub const HAND_ID_MAX: u16 = 0x3FFF;
/// Largest address: 12 bits (manual 2.3).
pub const ADDRESS_MAX: u16 = 0x0FFF;
/// Size of Linux's `struct can_frame`, in bytes.
pub const RECORD_LEN: usize = 16;
/// Maximum number of pieces of one read: 252 bytes cut at even addresses, plus a margin for shorter pieces.
pub const PIECES_MAX: usize = 64;

/// Identifiers have 29 bits.
const ID_MASK: u32 = 0x1FFF_FFFF;
/// Upper identifier bits by which Linux marks 29-bit identifiers, remote frames and error frames.
const EXTENDED: u32 = 0x8000_0000;
const REMOTE: u32 = 0x4000_0000;
const ERROR: u32 = 0x2000_0000;
/// Classes of Linux's error frames: controller state (given in byte 1), and bus-off.
const ERROR_CONTROLLER: u32 = 0x0000_0004;
const ERROR_BUS_OFF: u32 = 0x0000_0040;
/// Bits of an error frame's byte 1: receiver or transmitter error-passive; back to error-active.
const PASSIVE: u8 = 0x30;
const ACTIVE: u8 = 0x40;

/// The data bytes of one frame.
pub type CanData = ArrayVec<u8, 8>;
/// A memory range, cut into pieces that fit single frames.
pub type ReadPieces = ArrayVec<Span, PIECES_MAX>;

/// Operation of a frame: bits 26 to 28 of the identifier. The wrist's flags (4, 5) do not apply to this hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CanFunction {
    /// Flag 0.
    Read,
    /// Flag 1.
    Write,
}

/// A data frame with a 29-bit identifier, the only kind that the hand understands.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CanFrame {
    /// 0..=0x1FFF_FFFF.
    pub id: u32,
    /// 0 to 8 bytes.
    pub data: CanData,
}

/// The parts of an identifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CanId {
    /// Operation: read or write.
    pub way: CanFunction,
    /// Address of the first byte, 0..=4095.
    pub address: u16,
    /// Id of the hand, 0..=16383.
    pub hand: u16,
}

impl CanId {
    /// Encodes the identifier; `None` if the hand id or the address has too many bits.
    pub fn raw(self) -> Option<u32> {
        if self.hand > HAND_ID_MAX || self.address > ADDRESS_MAX {
            return None;
        }
        let way = match self.way {
            CanFunction::Read => 0,
            CanFunction::Write => 1,
        };
        Some((way << 26) | (u32::from(self.address) << 14) | u32::from(self.hand))
    }

    /// Decodes a 29-bit identifier; `None` for the wrist's flags and unknown flags.
    pub fn from_raw(id: u32) -> Option<Self> {
        let way = match id >> 26 {
            0 => CanFunction::Read,
            1 => CanFunction::Write,
            _ => return None,
        };
        Some(Self {
            way,
            address: u16::try_from((id >> 14) & u32::from(ADDRESS_MAX)).ok()?,
            hand: u16::try_from(id & u32::from(HAND_ID_MAX)).ok()?,
        })
    }
}

/// Builds the request that reads 1 to 8 bytes (manual 2.3.1); its only data byte is the length.
pub fn read_request(hand: u16, span: Span) -> Option<CanFrame> {
    if span.len == 0 || span.len > PIECE_MAX {
        return None;
    }
    let len = u8::try_from(span.len).ok()?;
    frame(CanFunction::Read, hand, span.address, &[len])
}

/// Builds a read reply, a write (manual 2.3.2) or a write reply for this address; `None` for more than 8 bytes.
pub fn frame(way: CanFunction, hand: u16, address: u16, data: &[u8]) -> Option<CanFrame> {
    let id = CanId { way, address, hand }.raw()?;
    let data = CanData::try_from(data).ok()?;
    Some(CanFrame { id, data })
}

/// Builds the frames that write these bytes, in address order; the hand answers each one separately.
pub fn write_requests(hand: u16, write: &RegisterWrite) -> Option<ArrayVec<CanFrame, 4>> {
    let span = write.span();
    split(span)?
        .into_iter()
        .map(|piece| {
            frame(
                CanFunction::Write,
                hand,
                piece.address,
                span.slice(write.bytes(), piece)?,
            )
        })
        .collect()
}

/// Cuts a range into pieces of 1 to 8 bytes, never through a short or a number of a fingertip block (manual 2.6.21).
/// `None` for an empty range, one past address 4095, or one of more than [`PIECES_MAX`] pieces.
// Manual: 2.3 does not cover more than 8 bytes; other drivers also split by address.
pub fn split(span: Span) -> Option<ReadPieces> {
    let end = u16::try_from(span.end()).ok()?;
    if span.len == 0 || end > ADDRESS_MAX + 1 {
        return None;
    }
    let mut pieces = ReadPieces::new();
    let mut from = span.address;
    while from < end {
        let last = end.min(from + PIECE_MAX);
        let cut = (from + 1..=last)
            .rev()
            .find(|at| *at == end || may_cut(*at))
            .unwrap_or(last);
        pieces.try_push(Span::new(from, cut - from)).ok()?;
        from = cut;
    }
    Some(pieces)
}

/// True if no number spans this address.
pub fn may_cut(at: u16) -> bool {
    if at <= TOUCH.address || u32::from(at) >= TOUCH.end() {
        return at.is_multiple_of(2);
    }
    // Eight raw values and four of force, four bytes each, direction, proximity, check, reserve.
    match (at - TOUCH.address) % 58 {
        inside @ 0..=48 => inside.is_multiple_of(4),
        inside => matches!(inside, 50 | 54 | 56),
    }
}

/// Record received from a CAN interface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CanRecord {
    /// A data frame with a 29-bit identifier.
    Frame(CanFrame),
    /// The controller is bus-off: it sends nothing until it is restarted.
    BusOff,
    /// The controller is error-passive after too many errors.
    ErrorPassive,
    /// The controller is error-active again.
    ErrorActive,
    /// Any other frame.
    Other,
}

/// Encodes a frame as Linux's `struct can_frame`.
pub fn to_record(frame: &CanFrame) -> [u8; RECORD_LEN] {
    let mut record = [0; RECORD_LEN];
    let id = ((frame.id & ID_MASK) | EXTENDED).to_ne_bytes();
    let len = u8::try_from(frame.data.len()).unwrap_or_default();
    let body = id.into_iter().chain([len, 0, 0, 0]);
    for (at, byte) in record
        .iter_mut()
        .zip(body.chain(frame.data.iter().copied()))
    {
        *at = byte;
    }
    record
}

/// Decodes a `struct can_frame`.
pub fn from_record(record: &[u8; RECORD_LEN]) -> CanRecord {
    let [a, b, c, d, len, _, _, _, data @ ..] = record;
    let id = u32::from_ne_bytes([*a, *b, *c, *d]);
    if id & ERROR != 0 {
        return trouble(id, data);
    }
    match data.get(..usize::from(*len)).map(CanData::try_from) {
        Some(Ok(data)) if id & EXTENDED != 0 && id & REMOTE == 0 => CanRecord::Frame(CanFrame {
            id: id & ID_MASK,
            data,
        }),
        _ => CanRecord::Other,
    }
}

fn trouble(id: u32, data: &[u8]) -> CanRecord {
    let state = data.get(1).copied().unwrap_or_default();
    if id & ERROR_BUS_OFF != 0 {
        CanRecord::BusOff
    } else if id & ERROR_CONTROLLER != 0 && state & PASSIVE != 0 {
        CanRecord::ErrorPassive
    } else if id & ERROR_CONTROLLER != 0 && state & ACTIVE != 0 {
        CanRecord::ErrorActive
    } else {
        CanRecord::Other
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "a test may"
    )]
    use super::*;
    use crate::hand::{HandCommand, PerDof, Speed};
    use proptest::prelude::*;

    #[test]
    fn the_manuals_frames_come_out_byte_for_byte() {
        // 2.3.1: ANGLE_ACT(3) of hand 1, and its answer 500.
        let ask = read_request(1, Span::new(1552, 2)).unwrap();
        assert_eq!((ask.id, &ask.data[..]), (0x0184_0001, &[0x02][..]));
        let answer = frame(CanFunction::Read, 1, 1552, &[0xF4, 0x01]).unwrap();
        assert_eq!(
            (answer.id, &answer.data[..]),
            (0x0184_0001, &[0xF4, 0x01][..])
        );
        // 2.3.2: ANGLE_SET(3) of hand 1 = 600.
        let write = frame(CanFunction::Write, 1, 1492, &[0x58, 0x02]).unwrap();
        assert_eq!(
            (write.id, &write.data[..]),
            (0x0575_0001, &[0x58, 0x02][..])
        );
        assert_eq!(
            CanId::from_raw(0x0575_0001),
            Some(CanId {
                way: CanFunction::Write,
                address: 1492,
                hand: 1
            })
        );
    }

    #[test]
    fn what_does_not_fit_the_identifier_is_none() {
        assert_eq!(read_request(1, Span::new(4096, 1)), None);
        assert_eq!(read_request(16_384, Span::new(1000, 1)), None);
        assert_eq!(read_request(1, Span::new(1000, 0)), None);
        assert_eq!(read_request(1, Span::new(1000, 9)), None);
        assert_eq!(split(Span::new(4095, 2)), None);
        assert_eq!(split(Span::new(1546, 0)), None);
        assert_eq!(split(Span::new(u16::MAX, u16::MAX)), None);
        assert!(split(Span::new(4088, 8)).is_some());
        for wrist in [4, 5] {
            assert_eq!(CanId::from_raw((wrist << 26) | 1), None);
        }
    }

    #[test]
    fn six_shorts_are_written_as_four_and_two() {
        let command = HandCommand::Speeds(PerDof::from_fn(|dof| {
            Speed::new(100 + dof.index() as i64).ok()
        }));
        let writes = command.writes();
        let frames: Vec<_> = writes
            .iter()
            .flat_map(|write| write_requests(1, write).unwrap())
            .collect();
        let parts: Vec<_> = frames
            .iter()
            .map(|frame| (CanId::from_raw(frame.id).unwrap().address, frame.data.len()))
            .collect();
        assert_eq!(parts, [(1522, 8), (1530, 4)]);
        assert_eq!(frames[1].data[..], [104, 0, 105, 0]);
    }

    #[test]
    fn a_fingertip_is_cut_between_its_numbers() {
        let cuts: Vec<_> = split(Span::new(3058, 58))
            .unwrap()
            .iter()
            .map(|piece| (piece.address - 3058, piece.len))
            .collect();
        let numbers = [(0, 8), (8, 8), (16, 8), (24, 8), (32, 8), (40, 8), (48, 8)];
        assert_eq!(cuts[..7], numbers);
        assert_eq!(cuts[7..], [(56, 2)]);
    }

    #[test]
    fn error_frames_of_the_interface_are_told_apart() {
        let of = |class: u32, state: u8| {
            let mut record = [0; RECORD_LEN];
            record[..4].copy_from_slice(&(0x2000_0000 | class).to_ne_bytes());
            record[4] = 8;
            record[9] = state;
            from_record(&record)
        };
        assert_eq!(of(0x40, 0), CanRecord::BusOff);
        assert_eq!(of(0x04, 0x20), CanRecord::ErrorPassive);
        assert_eq!(of(0x04, 0x10), CanRecord::ErrorPassive);
        assert_eq!(of(0x04, 0x40), CanRecord::ErrorActive);
        assert_eq!(of(0x04, 0x08), CanRecord::Other);
        assert_eq!(of(0x20, 0), CanRecord::Other);
    }

    proptest! {
        #[test]
        fn pieces_cover_the_run_in_order_and_cut_no_number(address in 0_u16..4096, len in 1_u16..253) {
            let span = Span::new(address, len);
            let Some(pieces) = split(span) else {
                prop_assert!(span.end() > 4096);
                return Ok(());
            };
            let mut at = u32::from(address);
            for piece in &pieces {
                prop_assert_eq!(u32::from(piece.address), at);
                prop_assert!((1..=8).contains(&piece.len));
                at = piece.end();
                prop_assert!(at == span.end() || may_cut(at as u16));
            }
            prop_assert_eq!(at, span.end());
        }

        #[test]
        fn identifiers_read_back(address in 0_u16..4096, hand in 0_u16..16384, write: bool) {
            let way = if write { CanFunction::Write } else { CanFunction::Read };
            let id = CanId { way, address, hand };
            prop_assert_eq!(CanId::from_raw(id.raw().unwrap()), Some(id));
        }

        #[test]
        fn records_read_back_and_no_record_panics(id in 0_u32..=0x1FFF_FFFF, data in prop::collection::vec(any::<u8>(), 0..9), any: [u8; 16]) {
            let frame = CanFrame { id, data: CanData::try_from(&data[..]).unwrap() };
            prop_assert_eq!(from_record(&to_record(&frame)), CanRecord::Frame(frame));
            if let CanRecord::Frame(frame) = from_record(&any) {
                prop_assert_eq!(from_record(&to_record(&frame)), CanRecord::Frame(frame));
            }
        }
    }
}
