//! Matches replies with requests, and finds what is out of place. One request is open at a time, as on the link.

use crate::codec::modbus::{detect_packing, group_bytes};
use crate::codec::rs485::SaveResult;
use crate::hand::register::BytePacking;
use crate::hand::register::{ERROR, SAVE, STATUS, TEMP};
use crate::hand::{Moment, Span};
use crate::link::traffic::content::FrameContent;
use crate::link::traffic::frame::{Frame, FrameFormat, Kind, Wrong};
use crate::link::traffic::rs485;
use crate::record::Direction;
use std::collections::VecDeque;
use std::time::Duration;

/// Requests without reply that a late reply can still match.
const GIVEN_UP_MAX: usize = 16;
/// A request that is open for this long counts as unanswered.
const REPLY_TIMEOUT: Duration = Duration::from_secs(1);

/// A request that waits for its reply.
#[derive(Debug, Clone, Copy)]
struct OpenRequest {
    number: u64,
    at: Moment,
    writes: bool,
    span: Span,
    transaction: Option<u16>,
}

impl OpenRequest {
    fn is_answered_by(&self, content: &FrameContent) -> bool {
        self.is_of_kind(content)
            && content.transaction == self.transaction
            && content
                .span
                .is_none_or(|span| span.address == self.span.address)
            && (self.writes || content.kind == Kind::Refusal || content.len == Some(self.span.len))
    }

    const fn is_of_kind(&self, content: &FrameContent) -> bool {
        match content.kind {
            Kind::Refusal => true,
            Kind::WriteReply => self.writes,
            _ => !self.writes,
        }
    }
}

/// Matching state of one link.
#[derive(Debug, Clone)]
pub struct Matching {
    form: FrameFormat,
    hand: u16,
    open: Option<OpenRequest>,
    given_up: VecDeque<OpenRequest>,
    saving: bool,
    packing: BytePacking,
}

impl Matching {
    /// State before the first request to this hand.
    pub fn new(form: FrameFormat, hand: u16) -> Self {
        Self {
            form,
            hand,
            open: None,
            given_up: VecDeque::new(),
            saving: false,
            packing: BytePacking::default(),
        }
    }

    /// Number of the open request, once it counts as unanswered.
    pub fn overdue(&mut self, now: Moment) -> Option<u64> {
        self.open
            .take_if(|open| now.since(open.at) >= REPLY_TIMEOUT)
            .map(|open| self.give_up(open))
    }

    /// Handles a new wire, on which earlier requests are not answered. Returns the number of the open request.
    pub fn renew(&mut self) -> Option<u64> {
        self.given_up.clear();
        self.open.take().map(|open| open.number)
    }

    /// Adds the content to a frame. If it is a request, returns the number of the previous one if that got no reply.
    pub fn place(&mut self, frame: &mut Frame, content: FrameContent) -> Option<u64> {
        frame.kind = content.kind;
        frame.hand = content.hand;
        frame.span = content.span;
        frame.wrong = frame.wrong.or(content.wrong);
        let foreign = content.hand.filter(|id| *id != self.hand);
        let mut before = None;
        if let Some(got) = foreign {
            let want = self.hand;
            frame.wrong = frame.wrong.or(Some(Wrong::ForeignId { got, want }));
        } else if frame.wrong.is_none_or(|wrong| !is_final(wrong)) {
            match (frame.direction, content.kind) {
                (Direction::ToHand, Kind::Read | Kind::Write) => {
                    before = self.note_request(frame, &content)
                }
                (Direction::FromHand, Kind::ReadReply | Kind::WriteReply | Kind::Refusal) => {
                    self.answer(frame, &content);
                }
                _ => {}
            }
        }
        frame.memory = content.memory.into_boxed_slice();
        self.unpack(frame);
        before
    }

    fn note_request(&mut self, frame: &Frame, content: &FrameContent) -> Option<u64> {
        let before = self.open.take().map(|open| self.give_up(open));
        let span = content.span?;
        self.saving |= content.kind == Kind::Write && span.address == SAVE.address;
        self.open = Some(OpenRequest {
            number: frame.number,
            at: frame.at,
            writes: content.kind == Kind::Write,
            span,
            transaction: content.transaction,
        });
        before
    }

    fn give_up(&mut self, open: OpenRequest) -> u64 {
        if self.given_up.len() >= GIVEN_UP_MAX {
            self.given_up.pop_front();
        }
        self.given_up.push_back(open);
        open.number
    }

    fn answer(&mut self, frame: &mut Frame, content: &FrameContent) {
        if let Some(open) = self.open.take_if(|open| open.is_answered_by(content)) {
            frame.took = Some(frame.at.since(open.at));
            frame.span = Some(open.span);
            return;
        }
        if self.is_save_result(frame, content) {
            return;
        }
        let late = self
            .given_up
            .iter()
            .position(|asked| asked.is_answered_by(content));
        if let Some(asked) = late.and_then(|at| self.given_up.remove(at)) {
            let after = frame.at.since(asked.at).as_millis();
            let after_ms = u64::try_from(after).unwrap_or(u64::MAX);
            frame.span = Some(asked.span);
            frame.wrong = Some(Wrong::Late { after_ms });
            return;
        }
        let wrong = self.misfit(content);
        frame.wrong = Some(wrong);
        // It was the reply, only a wrong one: no other will come.
        if matches!(wrong, Wrong::Amount { .. }) {
            self.open = None;
        }
    }

    fn misfit(&self, content: &FrameContent) -> Wrong {
        let Some(open) = self.open else {
            return Wrong::NotAsked;
        };
        if let (Some(got), Some(want)) = (content.transaction, open.transaction)
            && got != want
        {
            return Wrong::Transaction { got, want };
        }
        if !open.is_of_kind(content) {
            return Wrong::NotAsked;
        }
        let want = open.span.address;
        if let Some(got) = content
            .span
            .map(|span| span.address)
            .filter(|got| *got != want)
        {
            return Wrong::Address { got, want };
        }
        // Request and reply share an identifier on CAN, so an echo is recognised by its content.
        let is_can = matches!(
            self.form,
            FrameFormat::Can | FrameFormat::Slcan | FrameFormat::UsbCan
        );
        let asked_for = u8::try_from(open.span.len).unwrap_or(u8::MAX);
        if is_can && content.memory == [asked_for] {
            return Wrong::Echo;
        }
        Wrong::Amount {
            got: content.len.unwrap_or_default(),
            want: open.span.len,
        }
    }

    fn is_save_result(&mut self, frame: &mut Frame, content: &FrameContent) -> bool {
        if self.form != FrameFormat::Rs485 || !self.saving {
            return false;
        }
        let Some(result) = rs485::save_result(content) else {
            return false;
        };
        self.saving = false;
        frame.kind = Kind::SaveResult;
        frame.wrong = match result {
            SaveResult::Ok => None,
            SaveResult::Failed => Some(Wrong::NotSaved { value: 0xFF }),
            SaveResult::Other(value) => Some(Wrong::NotSaved { value }),
        };
        true
    }

    /// Some hands store one byte per word (manual 2.5 is silent); the link detects that at TEMP, and so does this code.
    fn unpack(&mut self, frame: &mut Frame) {
        let is_modbus = matches!(self.form, FrameFormat::Rtu | FrameFormat::Tcp);
        let Some(span) = frame
            .span
            .filter(|_| is_modbus && frame.kind == Kind::ReadReply)
        else {
            return;
        };
        let (pairs, _) = frame.memory.as_chunks::<2>();
        let words: Vec<u16> = pairs.iter().map(|pair| u16::from_le_bytes(*pair)).collect();
        // Over RTU the link requests more than six words if a late reply could have as many.
        let Some(six) = words.first_chunk::<6>() else {
            return;
        };
        if span.address == TEMP.address {
            self.packing = detect_packing(ANY_ID, six).unwrap_or_default();
        }
        let groups = [ERROR.address, STATUS.address, TEMP.address];
        if self.packing == BytePacking::OnePerWord
            && groups.contains(&span.address)
            && let Some(bytes) = group_bytes(self.packing, six)
        {
            frame.memory = Box::from(bytes);
            frame.span = Some(Span::new(span.address, 6));
        }
    }
}

/// The word at HAND_ID of a hand that puts the low byte first, as most do; only one byte per word is detected here.
const ANY_ID: u16 = 1;

/// True if a frame with this fault takes no part in matching.
const fn is_final(wrong: Wrong) -> bool {
    !matches!(
        wrong,
        Wrong::Refused { .. } | Wrong::NotTaken { .. } | Wrong::Amount { .. }
    )
}
