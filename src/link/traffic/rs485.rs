//! The private RS485 framing for the tap: finds frames, and extracts their content. The codec implements the framing itself.

use crate::codec::rs485::client::SaveResult;
use crate::codec::rs485::framing::{FrameDirection, FrameStart, WRITE, parts, scan};
use crate::hand::Span;
use crate::hand::register::SAVE;
use crate::link::traffic::content::FrameContent;
use crate::link::traffic::cut::FrameCut;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::record::Direction;

/// Finds a frame at the first byte, or the reason why there is none.
pub fn find_frame(bytes: &[u8]) -> FrameCut {
    match scan(bytes) {
        FrameStart::Frame(_, len) => FrameCut::Whole(len),
        FrameStart::BadSum { len, got, want } => {
            FrameCut::Damaged(len, Wrong::Checksum { got, want })
        }
        FrameStart::Open(want) => FrameCut::Open(want),
        FrameStart::BadHead { len, command } => FrameCut::Nothing(Wrong::BadHead { len, command }),
        FrameStart::Nothing => FrameCut::Nothing(Wrong::NoFrame { len: 1 }),
    }
}

/// Content of a frame; its checksum may be wrong.
pub fn content(direction: Direction, frame: &[u8]) -> FrameContent {
    let sent = match frame {
        [0xEB, ..] => FrameDirection::Request,
        _ => FrameDirection::Reply,
    };
    let Some(parts) = parts(frame) else {
        return FrameContent::new(Kind::Noise);
    };
    let data = parts.data.as_slice();
    let id = u16::from(parts.id);
    let carried = Span::new(parts.address, u16::try_from(data.len()).unwrap_or(u16::MAX));
    let first = data.first().copied().unwrap_or_default();
    let content = match (sent, parts.command == WRITE) {
        (FrameDirection::Request, false) => {
            FrameContent::new(Kind::Read).about(Span::new(parts.address, u16::from(first)))
        }
        (FrameDirection::Request, true) => FrameContent::new(Kind::Write).about(carried).with(data),
        (FrameDirection::Reply, false) => {
            FrameContent::new(Kind::ReadReply).about(carried).with(data)
        }
        (FrameDirection::Reply, true) => {
            let wrong = (first != 1).then_some(Wrong::NotTaken { value: first });
            let mut content = FrameContent::new(Kind::WriteReply).wrong(wrong);
            content.span = Some(Span::new(parts.address, 0));
            content
        }
    };
    content.hand(id).wrong(misplaced(direction, sent))
}

fn misplaced(direction: Direction, sent: FrameDirection) -> Option<Wrong> {
    match (direction, sent) {
        (Direction::FromHand, FrameDirection::Request) => Some(Wrong::Echo),
        (Direction::ToHand, FrameDirection::Reply) => Some(Wrong::Backwards),
        _ => None,
    }
}

/// The late result of a SAVE, if the content can only be that. The caller checks that one was requested.
pub fn save_result(content: &FrameContent) -> Option<SaveResult> {
    let address = content.span?.address;
    let value = match (content.kind, content.wrong, content.memory.as_slice()) {
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
