//! CAN for the tap: Linux's frames, and the text and the packets of serial adapters. What they hold is the codecs' to know.

use crate::codec::can::{CanFrame, CanId, RECORD_LEN, Record, Way, from_record};
use crate::codec::slcan::{Answer, AnswerDecoder, Command, CommandDecoder, LINE_MAX};
use crate::codec::usbcan::{Content, Found, inspect};
use crate::hand::Span;
use crate::link::tap::Direction;
use crate::link::traffic::cut::Seen;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::link::traffic::said::Said;

const CR: u8 = b'\r';
const BEL: u8 = 0x07;

/// What stands here of a CAN interface.
#[must_use]
pub const fn look_record(bytes: &[u8]) -> Seen {
    if bytes.len() >= RECORD_LEN {
        Seen::Whole(RECORD_LEN)
    } else {
        Seen::Open(Some(RECORD_LEN))
    }
}

/// What stands here of an adapter's line.
#[must_use]
pub fn look_line(bytes: &[u8]) -> Seen {
    match bytes.iter().position(|byte| matches!(*byte, CR | BEL)) {
        Some(end) if end <= LINE_MAX => Seen::Whole(end + 1),
        None if bytes.len() <= LINE_MAX => Seen::Open(None),
        Some(_) | None => Seen::Nothing(Wrong::NoFrame { len: 1 }),
    }
}

/// What stands here of the maker's adapter.
#[must_use]
pub fn look_packet(bytes: &[u8]) -> Seen {
    match inspect(bytes) {
        Found::Packet(len, _) => Seen::Whole(len),
        Found::BadSum { len, got, want } => Seen::Damaged(len, Wrong::Checksum { got, want }),
        Found::Open => Seen::Open(None),
        Found::Nothing => Seen::Nothing(Wrong::NoFrame { len: 1 }),
    }
}

/// What a packet says; one that is damaged says nothing.
#[must_use]
pub fn said_packet(direction: Direction, packet: &[u8]) -> Said {
    match (inspect(packet), direction) {
        (Found::Packet(_, Content::Frame(frame)), _) => said_frame(direction, &frame),
        (Found::Packet(..), Direction::ToHand) => Said::new(Kind::Adapter),
        (Found::Packet(..), Direction::FromHand) => Said::new(Kind::AdapterReply),
        _ => Said::new(Kind::Noise),
    }
}

/// What a frame of a CAN interface says.
#[must_use]
pub fn said_record(direction: Direction, record: &[u8]) -> Said {
    let Ok(record) = <&[u8; RECORD_LEN]>::try_from(record) else {
        return Said::new(Kind::Noise);
    };
    match from_record(record) {
        Record::Frame(frame) => said_frame(direction, &frame),
        Record::BusOff => Said::new(Kind::AdapterReply).wrong(Wrong::BusOff),
        Record::ErrorPassive => Said::new(Kind::AdapterReply).wrong(Wrong::ErrorPassive),
        Record::ErrorActive | Record::Other => Said::new(Kind::AdapterReply),
    }
}

/// What a line from or to an adapter says.
#[must_use]
pub fn said_line(direction: Direction, line: &[u8]) -> Said {
    match direction {
        Direction::ToHand => {
            let mut decoder = CommandDecoder::default();
            match line.iter().find_map(|byte| decoder.push(*byte)) {
                Some(Ok(Command::Send(frame))) => said_frame(direction, &frame),
                Some(Ok(_)) | None => Said::new(Kind::Adapter),
                Some(Err(_)) => Said::new(Kind::Adapter).wrong(Wrong::Line),
            }
        }
        Direction::FromHand => {
            let mut decoder = AnswerDecoder::default();
            let said = line.iter().find_map(|byte| decoder.push(*byte));
            let noisy = (decoder.counts().bad_lines > 0).then_some(Wrong::Line);
            match said {
                Some(Answer::Frame(frame)) => said_frame(direction, &frame).wrong(noisy),
                Some(Answer::Failed) => {
                    Said::new(Kind::AdapterReply).wrong(noisy.or(Some(Wrong::AdapterFailed)))
                }
                Some(Answer::Done | Answer::Sent | Answer::Other(_)) => {
                    Said::new(Kind::AdapterReply)
                }
                None => Said::noise(Wrong::Line),
            }
        }
    }
}

fn said_frame(direction: Direction, frame: &CanFrame) -> Said {
    let Some(id) = CanId::from_raw(frame.id) else {
        return Said::noise(Wrong::ForeignCanId { id: frame.id });
    };
    let data = frame.data.as_slice();
    let len = u16::try_from(data.len()).unwrap_or_default();
    let carried = Span::new(id.address, len);
    let said = match (direction, id.way, data) {
        (Direction::ToHand, Way::Read, [len]) => {
            Said::new(Kind::Read).about(Span::new(id.address, u16::from(*len)))
        }
        (Direction::ToHand, Way::Write, _) => Said::new(Kind::Write).about(carried).with(data),
        (Direction::FromHand, Way::Read, _) => Said::new(Kind::ReadReply).about(carried).with(data),
        (Direction::FromHand, Way::Write, _) => {
            let mut said = Said::new(Kind::WriteReply);
            said.span = Some(Span::new(id.address, 0));
            // An acknowledgement has one byte (manual 2.3.2); an adapter that echoes gives back all.
            said.wrong((len > 1).then_some(Wrong::Echo))
        }
        (Direction::ToHand, Way::Read, _) => Said::noise(Wrong::Amount { got: len, want: 1 }),
    };
    said.hand(id.hand)
}
