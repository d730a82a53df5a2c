//! The private RS485 framing for the tap: where frames are, and what they say. The framing itself is the codec's.

use crate::codec::rs485::client::SaveResult;
use crate::codec::rs485::inspect::{Found, Way, inspect, parts};
use crate::hand::Span;
use crate::hand::register::SAVE;
use crate::link::tap::Direction;
use crate::link::traffic::cut::FrameCut;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::link::traffic::said::FrameContent;

/// What stands here.
#[must_use]
pub fn look(bytes: &[u8]) -> FrameCut {
    match inspect(bytes) {
        Found::Frame(_, len) => FrameCut::Whole(len),
        Found::BadSum { len, got, want, .. } => {
            FrameCut::Damaged(len, Wrong::Checksum { got, want })
        }
        Found::Open(want) => FrameCut::Open(want),
        Found::BadHead { len, command } => FrameCut::Nothing(Wrong::BadHead { len, command }),
        Found::Nothing => FrameCut::Nothing(Wrong::NoFrame { len: 1 }),
    }
}

/// What a frame says; its checksum may be wrong.
#[must_use]
pub fn said(direction: Direction, frame: &[u8]) -> FrameContent {
    let way = match frame {
        [0xEB, ..] => Way::Request,
        _ => Way::Reply,
    };
    let Some(parts) = parts(frame) else {
        return FrameContent::new(Kind::Noise);
    };
    let data = parts.data.as_slice();
    let id = u16::from(parts.id);
    let carried = Span::new(parts.address, u16::try_from(data.len()).unwrap_or(u16::MAX));
    let first = data.first().copied().unwrap_or_default();
    let said = match (way, parts.writes) {
        (Way::Request, false) => {
            FrameContent::new(Kind::Read).about(Span::new(parts.address, u16::from(first)))
        }
        (Way::Request, true) => FrameContent::new(Kind::Write).about(carried).with(data),
        (Way::Reply, false) => FrameContent::new(Kind::ReadReply).about(carried).with(data),
        (Way::Reply, true) => {
            let wrong = (first != 1).then_some(Wrong::NotTaken { value: first });
            let mut said = FrameContent::new(Kind::WriteReply).wrong(wrong);
            said.span = Some(Span::new(parts.address, 0));
            said
        }
    };
    said.hand(id).wrong(misplaced(direction, way))
}

fn misplaced(direction: Direction, way: Way) -> Option<Wrong> {
    match (direction, way) {
        (Direction::FromHand, Way::Request) => Some(Wrong::Echo),
        (Direction::ToHand, Way::Reply) => Some(Wrong::Backwards),
        _ => None,
    }
}

/// The late frame that tells how a SAVE ended, where one was asked and nothing else can be meant.
#[must_use]
pub fn save_result(said: &FrameContent) -> Option<SaveResult> {
    let address = said.span?.address;
    let value = match (said.kind, said.wrong, said.memory.as_slice()) {
        (Kind::WriteReply, Some(Wrong::NotTaken { value }), _) => value,
        (Kind::ReadReply, None, [value]) => *value,
        _ => return None,
    };
    (address == SAVE.address).then_some(match value {
        0x00 => SaveResult::Ok,
        0xFF => SaveResult::Failed,
        other => SaveResult::Other(other),
    })
}
