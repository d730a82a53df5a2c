//! Modbus RTU and TCP for the tap: finds messages, and extracts their content. The codecs implement envelopes and functions.

use crate::codec::mbap::{MbapError, MbapSplitter};
use crate::codec::modbus_rtu::crc16;
use crate::codec::pdu::{self, Len, ModbusRole, Pdu};
use crate::hand::Span;
use crate::hand::register::{Element, by_address};
use crate::link::traffic::content::FrameContent;
use crate::link::traffic::cut::FrameCut;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::record::Direction;

/// Bytes before the function code of a TCP message.
const MBAP_LEN: usize = 7;

const fn side(direction: Direction) -> ModbusRole {
    match direction {
        Direction::ToHand => ModbusRole::Client,
        Direction::FromHand => ModbusRole::Server,
    }
}

/// Finds a frame of an RTU line at the first byte. `unit` is ours: a frame with a wrong CRC is accepted as damaged only
/// from it.
pub fn find_rtu(direction: Direction, unit: u8, bytes: &[u8]) -> FrameCut {
    let seen = find_pdu(side(direction), bytes);
    if direction == Direction::ToHand || matches!(seen, FrameCut::Whole(_)) {
        return seen;
    }
    // An adapter that echoes, or another program on the line: only a correct CRC is proof.
    match find_pdu(ModbusRole::Client, bytes) {
        echo @ FrameCut::Whole(_) => echo,
        _ => match (seen, bytes.first()) {
            (FrameCut::Damaged(..), Some(first)) if *first != unit => {
                FrameCut::Nothing(Wrong::NoFrame { len: 1 })
            }
            _ => seen,
        },
    }
}

fn find_pdu(side: ModbusRole, bytes: &[u8]) -> FrameCut {
    let len = match pdu::len(side, bytes.get(1..).unwrap_or_default()) {
        Len::Open => return FrameCut::Open(None),
        Len::None => return FrameCut::Nothing(Wrong::NoFrame { len: 1 }),
        Len::Known(len) => len + 3,
    };
    match bytes.get(..len).and_then(<[u8]>::split_last_chunk) {
        None => FrameCut::Open(Some(len)),
        Some((body, check)) => {
            let (got, want) = (u16::from_le_bytes(*check), crc16(body));
            if got == want {
                FrameCut::Whole(len)
            } else {
                FrameCut::Damaged(len, Wrong::Crc { got, want })
            }
        }
    }
}

/// Content of an RTU frame.
pub fn rtu_content(direction: Direction, frame: &[u8]) -> FrameContent {
    let [unit, pdu @ .., _, _] = frame else {
        return FrameContent::new(Kind::Noise);
    };
    let own = pdu::parse(side(direction), pdu);
    let content = match (direction, own) {
        (Direction::FromHand, Pdu::Other { .. }) => match pdu::parse(ModbusRole::Client, pdu) {
            Pdu::Other { .. } => pdu_content(own),
            asked => pdu_content(asked).wrong(Wrong::Echo),
        },
        _ => directed_content(direction, own),
    };
    content.hand(u16::from(*unit))
}

/// Finds a message of a Modbus TCP connection at the first byte.
pub fn find_tcp(bytes: &[u8]) -> FrameCut {
    let mut splitter = MbapSplitter::default();
    splitter.push(bytes);
    match splitter.next() {
        Ok(Some(adu)) => FrameCut::Whole(adu.bytes.len()),
        Ok(None) => FrameCut::Open(match bytes.get(4..6) {
            Some([high, low]) => Some(6 + usize::from(u16::from_be_bytes([*high, *low]))),
            _ => None,
        }),
        Err(MbapError::Protocol { got }) => FrameCut::Nothing(Wrong::Protocol { got }),
        Err(MbapError::Length { got }) => FrameCut::Nothing(Wrong::LengthField { got }),
    }
}

/// Content of a Modbus TCP message.
pub fn tcp_content(direction: Direction, frame: &[u8]) -> FrameContent {
    let (Some([t0, t1, _, _, _, _, unit]), Some(pdu)) =
        (frame.first_chunk::<MBAP_LEN>(), frame.get(MBAP_LEN..))
    else {
        return FrameContent::new(Kind::Noise);
    };
    let mut content = directed_content(direction, pdu::parse(side(direction), pdu));
    content.transaction = Some(u16::from_be_bytes([*t0, *t1]));
    content.hand(u16::from(*unit))
}

/// One-register writes look the same both ways; the direction distinguishes them.
fn directed_content(direction: Direction, pdu: Pdu<'_>) -> FrameContent {
    let mut content = pdu_content(pdu);
    if direction == Direction::FromHand && content.kind == Kind::Write {
        content.kind = Kind::WriteReply;
        content.memory.clear();
    }
    content
}

fn pdu_content(pdu: Pdu<'_>) -> FrameContent {
    match pdu {
        Pdu::Read { address, count } => {
            FrameContent::new(Kind::Read).about(Span::new(address, count.saturating_mul(2)))
        }
        Pdu::Words(words) => {
            let mut content = FrameContent::new(Kind::ReadReply).with(&swapped(words));
            content.len = u16::try_from(words.len()).ok();
            content
        }
        Pdu::WriteOne { address, value } => {
            let bytes = value.to_le_bytes();
            let is_byte = by_address(address).is_some_and(|row| row.element == Element::Byte);
            let bytes = bytes.get(..if is_byte { 1 } else { 2 }).unwrap_or_default();
            let len = u16::try_from(bytes.len()).unwrap_or_default();
            FrameContent::new(Kind::Write)
                .about(Span::new(address, len))
                .with(bytes)
        }
        Pdu::Write {
            address,
            count,
            words,
        } => {
            let (got, want) = (
                u16::try_from(words.len()).unwrap_or(u16::MAX),
                count.saturating_mul(2),
            );
            FrameContent::new(Kind::Write)
                .about(Span::new(address, got))
                .with(&swapped(words))
                .wrong((got != want).then_some(Wrong::Amount { got, want }))
        }
        Pdu::Written { address, count } => {
            FrameContent::new(Kind::WriteReply).about(Span::new(address, count.saturating_mul(2)))
        }
        Pdu::Exception { code, .. } => {
            FrameContent::new(Kind::Refusal).wrong(Wrong::Refused { code })
        }
        Pdu::Other { function } => FrameContent::noise(Wrong::Function { function }),
    }
}

/// Converts words from the wire, high byte first, to memory order.
fn swapped(words: &[u8]) -> Vec<u8> {
    let (pairs, _) = words.as_chunks::<2>();
    pairs.iter().flat_map(|[high, low]| [*low, *high]).collect()
}
