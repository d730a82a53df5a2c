//! Modbus RTU and TCP for the tap: where messages are, and what they say. Envelopes and functions are the codecs'.

use crate::codec::mbap::{MbapError, MbapSplitter};
use crate::codec::modbus_rtu::crc16;
use crate::codec::pdu::{self, Len, Pdu, Side};
use crate::hand::Span;
use crate::hand::register::{Element, by_address};
use crate::link::tap::Direction;
use crate::link::traffic::cut::Seen;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::link::traffic::said::Said;

/// Bytes before the function code of a TCP message.
const MBAP_LEN: usize = 7;

const fn side(direction: Direction) -> Side {
    match direction {
        Direction::ToHand => Side::Client,
        Direction::FromHand => Side::Server,
    }
}

/// What stands here of an RTU line. `unit` is ours: only from it is a frame with a wrong check taken for one.
#[must_use]
pub fn look_rtu(direction: Direction, unit: u8, bytes: &[u8]) -> Seen {
    let seen = look_side(side(direction), bytes);
    if direction == Direction::ToHand || matches!(seen, Seen::Whole(_)) {
        return seen;
    }
    // An adapter that echoes, or another program on the line: only a good check tells.
    match look_side(Side::Client, bytes) {
        echo @ Seen::Whole(_) => echo,
        _ => match (seen, bytes.first()) {
            (Seen::Damaged(..), Some(first)) if *first != unit => {
                Seen::Nothing(Wrong::NoFrame { len: 1 })
            }
            _ => seen,
        },
    }
}

fn look_side(side: Side, bytes: &[u8]) -> Seen {
    let len = match pdu::len(side, bytes.get(1..).unwrap_or_default()) {
        Len::Open => return Seen::Open(None),
        Len::None => return Seen::Nothing(Wrong::NoFrame { len: 1 }),
        Len::Known(len) => len + 3,
    };
    match bytes.get(..len).and_then(<[u8]>::split_last_chunk) {
        None => Seen::Open(Some(len)),
        Some((body, check)) => {
            let (got, want) = (u16::from_le_bytes(*check), crc16(body));
            if got == want {
                Seen::Whole(len)
            } else {
                Seen::Damaged(len, Wrong::Crc { got, want })
            }
        }
    }
}

/// What an RTU frame says.
#[must_use]
pub fn said_rtu(direction: Direction, frame: &[u8]) -> Said {
    let [unit, pdu @ .., _, _] = frame else {
        return Said::new(Kind::Noise);
    };
    let own = pdu::parse(side(direction), pdu);
    let said = match (direction, own) {
        (Direction::FromHand, Pdu::Other { .. }) => match pdu::parse(Side::Client, pdu) {
            Pdu::Other { .. } => said(own),
            asked => said(asked).wrong(Wrong::Echo),
        },
        _ => said_by(direction, own),
    };
    said.hand(u16::from(*unit))
}

/// What stands here of a Modbus TCP connection.
#[must_use]
pub fn look_tcp(bytes: &[u8]) -> Seen {
    let mut splitter = MbapSplitter::default();
    splitter.push(bytes);
    match splitter.next() {
        Ok(Some(adu)) => Seen::Whole(adu.bytes.len()),
        Ok(None) => Seen::Open(match bytes.get(4..6) {
            Some([high, low]) => Some(6 + usize::from(u16::from_be_bytes([*high, *low]))),
            _ => None,
        }),
        Err(MbapError::Protocol { got }) => Seen::Nothing(Wrong::Protocol { got }),
        Err(MbapError::Length { got }) => Seen::Nothing(Wrong::LengthField { got }),
    }
}

/// What a Modbus TCP message says.
#[must_use]
pub fn said_tcp(direction: Direction, frame: &[u8]) -> Said {
    let (Some([t0, t1, _, _, _, _, unit]), Some(pdu)) =
        (frame.first_chunk::<MBAP_LEN>(), frame.get(MBAP_LEN..))
    else {
        return Said::new(Kind::Noise);
    };
    let mut said = said_by(direction, pdu::parse(side(direction), pdu));
    said.transaction = Some(u16::from_be_bytes([*t0, *t1]));
    said.hand(u16::from(*unit))
}

/// One-register writes look the same both ways; the direction says which it is.
fn said_by(direction: Direction, pdu: Pdu<'_>) -> Said {
    let mut said = said(pdu);
    if direction == Direction::FromHand && said.kind == Kind::Write {
        said.kind = Kind::WriteReply;
        said.memory.clear();
    }
    said
}

fn said(pdu: Pdu<'_>) -> Said {
    match pdu {
        Pdu::Read { address, count } => {
            Said::new(Kind::Read).about(Span::new(address, count.saturating_mul(2)))
        }
        Pdu::Words(words) => {
            let mut said = Said::new(Kind::ReadReply).with(&swapped(words));
            said.len = u16::try_from(words.len()).ok();
            said
        }
        Pdu::WriteOne { address, value } => {
            let bytes = value.to_le_bytes();
            let is_byte = by_address(address).is_some_and(|row| row.element == Element::Byte);
            let bytes = bytes.get(..if is_byte { 1 } else { 2 }).unwrap_or_default();
            let len = u16::try_from(bytes.len()).unwrap_or_default();
            Said::new(Kind::Write)
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
            Said::new(Kind::Write)
                .about(Span::new(address, got))
                .with(&swapped(words))
                .wrong((got != want).then_some(Wrong::Amount { got, want }))
        }
        Pdu::Written { address, count } => {
            Said::new(Kind::WriteReply).about(Span::new(address, count.saturating_mul(2)))
        }
        Pdu::Exception { code, .. } => Said::new(Kind::Refusal).wrong(Wrong::Refused { code }),
        Pdu::Other { function } => Said::noise(Wrong::Function { function }),
    }
}

/// Words from the wire, high byte first, as memory has them.
fn swapped(words: &[u8]) -> Vec<u8> {
    let (pairs, _) = words.as_chunks::<2>();
    pairs.iter().flat_map(|[high, low]| [*low, *high]).collect()
}
