//! Decodes the pieces of a tap into frames, for one link. Pure: no clock, no lock; the same pieces give the same frames.

use crate::hand::Moment;
use crate::link::traffic::content::FrameContent;
use crate::link::traffic::cut::{Cutter, FrameCut, StreamPiece};
use crate::link::traffic::frame::{Frame, FrameFormat, Kind, Wrong};
use crate::link::traffic::matching::Matching;
use crate::link::traffic::{can, modbus, rs485};
use crate::record::{Direction, Piece, PieceKind};
use crate::transport::Endpoint;
use std::time::Duration;

/// After this long without a byte an incomplete frame counts as ended: a reply's pieces follow one another within the
/// 16 ms of a USB adapter.
pub const SILENCE: Duration = Duration::from_millis(25);

/// Result of decoding some bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TrafficEvent {
    /// A complete frame, valid or not.
    Frame(Frame),
    /// The request with this number got no reply.
    NoReply(u64),
}

/// One direction of the wire.
#[derive(Debug, Clone, Default)]
struct Half {
    cutter: Cutter,
    /// Time of its last byte.
    last: Moment,
}

/// Decodes pieces into frames.
#[derive(Debug, Clone)]
pub struct Decoder {
    form: FrameFormat,
    unit: u8,
    to_hand: Half,
    from_hand: Half,
    matching: Matching,
    number: u64,
}

impl Decoder {
    /// A decoder for a link to this hand.
    pub fn new(endpoint: &Endpoint) -> Self {
        let form = FrameFormat::of(endpoint);
        let hand = endpoint.id_or_unit();
        Self {
            form,
            unit: u8::try_from(hand).unwrap_or_default(),
            to_hand: Half::default(),
            from_hand: Half::default(),
            matching: Matching::new(form, hand),
            number: 0,
        }
    }

    /// Decodes the next piece of recorded bytes; frames that end in it are added to `out`.
    pub fn push(&mut self, piece: &Piece, out: &mut Vec<TrafficEvent>) {
        self.tick(piece.at, out);
        match piece.kind {
            PieceKind::Bytes(direction) => self.bytes(piece.at, direction, &piece.bytes, out),
            PieceKind::Opened => self.wire(piece.at, Kind::Opened, out),
            PieceKind::Broken => self.wire(piece.at, Kind::Broken, out),
            PieceKind::Closed => self.wire(piece.at, Kind::Closed, out),
        }
    }

    /// Records that pieces are missing here.
    pub fn gap(&mut self, at: Moment, pieces: u64, out: &mut Vec<TrafficEvent>) {
        self.wire(at, Kind::Gap, out);
        if let Some(TrafficEvent::Frame(frame)) = out.last_mut() {
            frame.wrong = Some(Wrong::Forgotten { pieces });
        }
    }

    /// Advances time: bytes incomplete for [`SILENCE`] are emitted as they are.
    pub fn tick(&mut self, now: Moment, out: &mut Vec<TrafficEvent>) {
        for direction in [Direction::ToHand, Direction::FromHand] {
            let half = self.half(direction);
            if half.cutter.waiting() > 0 && now.since(half.last) >= SILENCE {
                self.flush(direction, out);
            }
        }
        out.extend(self.matching.overdue(now).map(TrafficEvent::NoReply));
    }

    /// Number of incomplete bytes, of both directions.
    pub const fn waiting(&self) -> usize {
        self.to_hand.cutter.waiting() + self.from_hand.cutter.waiting()
    }

    const fn half(&mut self, direction: Direction) -> &mut Half {
        match direction {
            Direction::ToHand => &mut self.to_hand,
            Direction::FromHand => &mut self.from_hand,
        }
    }

    fn bytes(
        &mut self,
        at: Moment,
        direction: Direction,
        bytes: &[u8],
        out: &mut Vec<TrafficEvent>,
    ) {
        let look = frame_finder(self.form, self.unit, direction);
        let half = self.half(direction);
        half.last = at;
        let mut cuts = Vec::new();
        half.cutter.push(bytes, look, |cut| cuts.push(cut));
        for cut in cuts {
            self.frame(at, direction, cut, out);
        }
    }

    fn flush(&mut self, direction: Direction, out: &mut Vec<TrafficEvent>) {
        let look = frame_finder(self.form, self.unit, direction);
        let half = self.half(direction);
        let at = half.last;
        let mut cuts = Vec::new();
        half.cutter.flush(look, |cut| cuts.push(cut));
        for cut in cuts {
            self.frame(at, direction, cut, out);
        }
    }

    fn frame(
        &mut self,
        at: Moment,
        direction: Direction,
        cut: StreamPiece,
        out: &mut Vec<TrafficEvent>,
    ) {
        let content = match cut.wrong {
            None => content(self.form, direction, &cut.bytes),
            Some(wrong @ (Wrong::Checksum { .. } | Wrong::Crc { .. })) => {
                content(self.form, direction, &cut.bytes).wrong(wrong)
            }
            Some(wrong) => FrameContent::noise(wrong),
        };
        let mut frame = self.empty(at, direction, content.kind);
        frame.bytes = cut.bytes.into_boxed_slice();
        // Damage takes precedence over the content of damaged bytes.
        frame.wrong = cut.wrong;
        out.extend(
            self.matching
                .place(&mut frame, content)
                .map(TrafficEvent::NoReply),
        );
        out.push(TrafficEvent::Frame(frame));
    }

    fn wire(&mut self, at: Moment, kind: Kind, out: &mut Vec<TrafficEvent>) {
        self.flush(Direction::ToHand, out);
        self.flush(Direction::FromHand, out);
        out.extend(self.matching.renew().map(TrafficEvent::NoReply));
        let direction = match kind {
            Kind::Opened | Kind::Closed => Direction::ToHand,
            _ => Direction::FromHand,
        };
        let frame = self.empty(at, direction, kind);
        out.push(TrafficEvent::Frame(frame));
    }

    fn empty(&mut self, at: Moment, direction: Direction, kind: Kind) -> Frame {
        self.number += 1;
        Frame {
            number: self.number,
            at,
            direction,
            form: self.form,
            bytes: Box::default(),
            kind,
            hand: None,
            span: None,
            memory: Box::default(),
            wrong: None,
            took: None,
        }
    }
}

fn frame_finder(form: FrameFormat, unit: u8, direction: Direction) -> impl Fn(&[u8]) -> FrameCut {
    move |bytes| match form {
        FrameFormat::Rs485 => rs485::find_frame(bytes),
        FrameFormat::Rtu => modbus::find_rtu(direction, unit, bytes),
        FrameFormat::Tcp => modbus::find_tcp(bytes),
        FrameFormat::Can => can::find_record(bytes),
        FrameFormat::Slcan => can::find_line(bytes),
        FrameFormat::UsbCan => can::find_packet(bytes),
    }
}

fn content(form: FrameFormat, direction: Direction, bytes: &[u8]) -> FrameContent {
    match form {
        FrameFormat::Rs485 => rs485::content(direction, bytes),
        FrameFormat::Rtu => modbus::rtu_content(direction, bytes),
        FrameFormat::Tcp => modbus::tcp_content(direction, bytes),
        FrameFormat::Can => can::record_content(direction, bytes),
        FrameFormat::Slcan => can::line_content(direction, bytes),
        FrameFormat::UsbCan => can::packet_content(direction, bytes),
    }
}
