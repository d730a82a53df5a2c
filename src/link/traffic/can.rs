//! CAN for the tap: Linux's frames, and the text and the packets of serial adapters. The codecs decode their contents.

use crate::codec::can::{CanFrame, CanFunction, CanId, CanRecord, RECORD_LEN, from_record};
use crate::codec::slcan::{AnswerDecoder, CommandDecoder, LINE_MAX, SlcanAnswer, SlcanCommand};
use crate::codec::usbcan::{PacketContent, PacketStart, inspect};
use crate::hand::Span;
use crate::link::traffic::content::FrameContent;
use crate::link::traffic::cut::FrameCut;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::record::Direction;

const CR: u8 = b'\r';
const BEL: u8 = 0x07;

/// Finds a frame of a CAN interface at the first byte.
pub const fn find_record(bytes: &[u8]) -> FrameCut {
    if bytes.len() >= RECORD_LEN {
        FrameCut::Whole(RECORD_LEN)
    } else {
        FrameCut::Open(Some(RECORD_LEN))
    }
}

/// Finds a line of a serial adapter at the first byte.
pub fn find_line(bytes: &[u8]) -> FrameCut {
    match bytes.iter().position(|byte| matches!(*byte, CR | BEL)) {
        Some(end) if end <= LINE_MAX => FrameCut::Whole(end + 1),
        None if bytes.len() <= LINE_MAX => FrameCut::Open(None),
        Some(_) | None => FrameCut::Nothing(Wrong::NoFrame { len: 1 }),
    }
}

/// Finds a packet of the maker's adapter at the first byte.
pub fn find_packet(bytes: &[u8]) -> FrameCut {
    match inspect(bytes) {
        PacketStart::Packet(len, _) => FrameCut::Whole(len),
        PacketStart::BadSum { len, got, want } => {
            FrameCut::Damaged(len, Wrong::Checksum { got, want })
        }
        PacketStart::Open => FrameCut::Open(None),
        PacketStart::Nothing => FrameCut::Nothing(Wrong::NoFrame { len: 1 }),
    }
}

/// Content of a packet; a damaged one has none.
pub fn packet_content(direction: Direction, packet: &[u8]) -> FrameContent {
    match (inspect(packet), direction) {
        (PacketStart::Packet(_, PacketContent::Frame(frame)), _) => {
            frame_content(direction, &frame)
        }
        (PacketStart::Packet(..), Direction::ToHand) => FrameContent::new(Kind::Adapter),
        (PacketStart::Packet(..), Direction::FromHand) => FrameContent::new(Kind::AdapterReply),
        _ => FrameContent::new(Kind::Noise),
    }
}

/// Content of a frame of a CAN interface.
pub fn record_content(direction: Direction, record: &[u8]) -> FrameContent {
    let Ok(record) = <&[u8; RECORD_LEN]>::try_from(record) else {
        return FrameContent::new(Kind::Noise);
    };
    match from_record(record) {
        CanRecord::Frame(frame) => frame_content(direction, &frame),
        CanRecord::BusOff => FrameContent::new(Kind::AdapterReply).wrong(Wrong::BusOff),
        CanRecord::ErrorPassive => FrameContent::new(Kind::AdapterReply).wrong(Wrong::ErrorPassive),
        CanRecord::ErrorActive | CanRecord::Other => FrameContent::new(Kind::AdapterReply),
    }
}

/// Content of a line from or to an adapter.
pub fn line_content(direction: Direction, line: &[u8]) -> FrameContent {
    match direction {
        Direction::ToHand => {
            let mut decoder = CommandDecoder::default();
            match line.iter().find_map(|byte| decoder.push(*byte)) {
                Some(Ok(SlcanCommand::Send(frame))) => frame_content(direction, &frame),
                Some(Ok(_)) | None => FrameContent::new(Kind::Adapter),
                Some(Err(_)) => FrameContent::new(Kind::Adapter).wrong(Wrong::Line),
            }
        }
        Direction::FromHand => {
            let mut decoder = AnswerDecoder::default();
            let content = line.iter().find_map(|byte| decoder.push(*byte));
            let noisy = (decoder.counts().resyncs > 0).then_some(Wrong::Line);
            match content {
                Some(SlcanAnswer::Frame(frame)) => frame_content(direction, &frame).wrong(noisy),
                Some(SlcanAnswer::Failed) => FrameContent::new(Kind::AdapterReply)
                    .wrong(noisy.or(Some(Wrong::AdapterFailed))),
                Some(SlcanAnswer::Done | SlcanAnswer::Sent | SlcanAnswer::Other(_)) => {
                    FrameContent::new(Kind::AdapterReply)
                }
                None => FrameContent::noise(Wrong::Line),
            }
        }
    }
}

fn frame_content(direction: Direction, frame: &CanFrame) -> FrameContent {
    let Some(id) = CanId::from_raw(frame.id) else {
        return FrameContent::noise(Wrong::ForeignCanId { id: frame.id });
    };
    let data = frame.data.as_slice();
    let len = u16::try_from(data.len()).unwrap_or_default();
    let carried = Span::new(id.address, len);
    let content = match (direction, id.way, data) {
        (Direction::ToHand, CanFunction::Read, [len]) => {
            FrameContent::new(Kind::Read).about(Span::new(id.address, u16::from(*len)))
        }
        (Direction::ToHand, CanFunction::Write, _) => {
            FrameContent::new(Kind::Write).about(carried).with(data)
        }
        (Direction::FromHand, CanFunction::Read, _) => {
            FrameContent::new(Kind::ReadReply).about(carried).with(data)
        }
        (Direction::FromHand, CanFunction::Write, _) => {
            let mut content = FrameContent::new(Kind::WriteReply);
            content.span = Some(Span::new(id.address, 0));
            // An acknowledgement has one byte (manual 2.3.2); an adapter that echoes returns all.
            content.wrong((len > 1).then_some(Wrong::Echo))
        }
        (Direction::ToHand, CanFunction::Read, _) => {
            FrameContent::noise(Wrong::Amount { got: len, want: 1 })
        }
    };
    content.hand(id.hand)
}
