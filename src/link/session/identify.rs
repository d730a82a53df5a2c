//! Identifies a hand on a fresh wire, by reading only: detects whether it is present and how it differs from others.
//! Bounded in time, and cut short by a stop; nothing is written.

use crate::codec::modbus::{detect_packing, words_per_group};
use crate::hand::register::{ANGLE_ACT, BytePacking, HAND_ID, REDU_RATIO, TEMP, TOUCH};
use crate::hand::{Moment, Span};
use crate::link::bus::late_replies::REPLY_LIMIT_MIN;
use crate::link::bus::{Bus, BusError, Bytes};
use crate::link::quirks::{GapRead, Quirks, TouchDoubt, TouchVariant};
use crate::link::series::{DeviceSeries, SeriesEvidence, SeriesQuestion};
use crate::link::session::conversation::{Session, WireEnd, closed, stopped, unless_lost};
use crate::link::status::LinkTrouble;
use std::sync::Arc;
use std::time::Duration;

/// Attempts to get a first answer on a fresh wire.
const TRIES: u32 = 3;
/// No further request starts later than this after the first answer: a reconnect must not wait.
const WITHIN: Duration = Duration::from_millis(400);
/// Delay between two series of reads while it is unclear whether this is a hand of the series.
const EVIDENCE_INTERVAL: Duration = Duration::from_millis(500);
/// Number of consecutive reads that a slow link is given time for.
const QUESTIONS: u32 = 8;
/// Attempts per read: one lost reply must not look like a quirk.
const ATTEMPTS: u32 = 2;

/// Read shapes for the id and for the baud rate code, each of another length.
const ID_SHAPES: [Span; 3] = [
    HAND_ID.span(),
    Span::new(HAND_ID.address, 3),
    Span::new(HAND_ID.address, 6),
];
const BAUD_SHAPES: [Span; 3] = [
    REDU_RATIO.span(),
    Span::new(REDU_RATIO.address, 3),
    Span::new(REDU_RATIO.address, 5),
];
/// From ANGLE_ACT across the unused addresses into FORCE_ACT. It begins at a group's base, because the meaning of an
/// address inside a group is undefined over Modbus.
const GAP_SHAPES: [Span; 4] = [
    Span::new(ANGLE_ACT.address, 38),
    Span::new(ANGLE_ACT.address, 40),
    Span::new(ANGLE_ACT.address, 42),
    Span::new(ANGLE_ACT.address, 44),
];
/// One fingertip and a little more, so that no read of the poll plan has the same shape; and another fingertip.
const TOUCH_SHAPES: [Span; 3] = [
    Span::new(TOUCH.address, 60),
    Span::new(TOUCH.address, 62),
    Span::new(TOUCH.address, 64),
];
const OTHER_TOUCH_SHAPES: [Span; 3] = [
    Span::new(TOUCH.address + 3 * 58, 62),
    Span::new(TOUCH.address + 3 * 58, 64),
    Span::new(TOUCH.address + 3 * 58, 66),
];

/// Result of a read during identification.
#[expect(
    clippy::large_enum_variant,
    reason = "it lives on the stack, for one question"
)]
enum IdentityReply {
    Bytes(Bytes),
    Refused,
    /// A gateway or a busy device refused.
    Busy,
    Silent,
    /// Not sent: no time was left, or no unambiguous shape.
    Unasked,
}

impl Session {
    /// Reads until the hand answers, then detects its quirks. The session continues from there.
    pub(crate) async fn identify(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let closed = closed(Arc::clone(&self.ends.wanted));
        tokio::select! {
            biased;
            () = closed => Err(WireEnd::Closed),
            known = self.get_to_know(bus) => known,
        }
    }

    async fn get_to_know(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let id = self.first_answer(bus).await?;
        // Of the earlier control requests only a stop applies to this hand.
        self.keep_pressed_stop();
        self.forget_wishes();
        let known = self.status.quirks;
        let until = self.now().plus(self.identifies_within());
        let packing = self.detect_packing(bus, id.as_ref(), until).await?;
        bus.set_packing(packing);
        self.evidence = SeriesEvidence::default();
        // A device of another series keeps that verdict until it shows otherwise: a stop that cuts the reads short must
        // not reach it.
        if self.status.series == DeviceSeries::Ours {
            self.status.series = DeviceSeries::Unknown;
        }
        self.detect_series(bus, until).await?;
        self.status.quirks = Quirks {
            packing,
            hand_id: id.as_ref().and_then(|id| first_byte(id, packing)),
            ..self.detect_quirks(bus, until).await?
        };
        self.evidence.fingertips(self.status.quirks.touch);
        // A stop cut the reads short: the known quirks of this hand still apply.
        if self.is_stop_wanted() && known.hand_id == self.status.quirks.hand_id {
            bus.set_packing(known.packing);
            self.status.quirks = known;
        }
        self.judge_series()
    }

    /// Reads groups until it is clear whether this is a hand of the series.
    async fn detect_series(&mut self, bus: &mut dyn Bus, until: Moment) -> Result<(), WireEnd> {
        for question in SeriesQuestion::ALL {
            if self.evidence.needs(question) {
                let reply = self.read_shapes(bus, question.shapes(), until).await?;
                self.note_evidence(question, &reply);
            }
        }
        self.judge_series()
    }

    fn note_evidence(&mut self, question: SeriesQuestion, reply: &IdentityReply) {
        match reply {
            IdentityReply::Bytes(bytes) => {
                let is_it = |shape: &&Span| usize::from(shape.len) == bytes.len();
                if let Some(span) = question.shapes().iter().find(is_it) {
                    self.evidence.read(question, *span, bytes);
                }
            }
            IdentityReply::Refused => self.evidence.refused(question),
            IdentityReply::Silent | IdentityReply::Busy | IdentityReply::Unasked => {}
        }
    }

    /// Makes one more read while the series is unclear; true if it did. A job or a poll has its turn between two.
    pub(crate) async fn identify_further(&mut self, bus: &mut dyn Bus) -> Result<bool, WireEnd> {
        let now = self.now();
        if self.status.series != DeviceSeries::Unknown || now < self.evidence_due {
            return Ok(false);
        }
        if std::mem::take(&mut self.asked_evidence) {
            return Ok(false);
        }
        let Some(question) = self.evidence.next_question() else {
            self.evidence.begin_again();
            self.evidence_due = now.plus(EVIDENCE_INTERVAL);
            return Ok(false);
        };
        self.asked_evidence = true;
        let reply = self
            .read_shapes_once(bus, question.shapes(), now.plus(WITHIN))
            .await?;
        self.note_evidence(question, &reply);
        self.judge_series()?;
        Ok(true)
    }

    fn judge_series(&mut self) -> Result<(), WireEnd> {
        let series = match self.evidence.verdict() {
            DeviceSeries::Unknown if self.status.series == DeviceSeries::Other => {
                DeviceSeries::Other
            }
            verdict => verdict,
        };
        if self.status.series != series {
            self.status.series = series;
            self.publish();
        }
        if series == DeviceSeries::Other {
            let place = self.dialled.place();
            return Err(WireEnd::Lost(LinkTrouble::OtherSeries { place }));
        }
        Ok(())
    }

    /// Reads the id until a reply comes. A refusal by the hand is an answer too, without an id.
    async fn first_answer(&mut self, bus: &mut dyn Bus) -> Result<Option<Bytes>, WireEnd> {
        let mut tries = 0;
        while tries < TRIES {
            tries += 1;
            self.turn(bus).await?;
            // If all shapes are ambiguous, the same read of the id may be repeated: the id does not change.
            let span = bus.choose(&ID_SHAPES).unwrap_or(HAND_ID.span());
            let span = Span::new(span.address, span.len + u16::from(bus.has_words()));
            let limit = self.first_limit(bus, span.len, tries);
            let asked = self.now();
            match bus.read(span, limit).await {
                Ok(bytes) => {
                    self.answered(self.now().since(asked));
                    self.learn_late(bus);
                    return Ok(Some(bytes));
                }
                Err(BusError::WrongLength { .. }) => return Ok(None),
                // A gateway that reports this for long enough ends the loop, so its exceptions do not count as attempts.
                Err(error @ BusError::Refused { .. }) => {
                    self.failed(bus, &error).await?;
                    if self.absence.last().is_none() {
                        return Ok(None);
                    }
                    tries -= 1;
                }
                Err(BusError::Lost(error)) => return Err(WireEnd::Lost(error.into())),
                Err(BusError::Timeout { .. } | BusError::TooLong | BusError::Ambiguous) => {
                    self.counters.stats.timeouts += 1;
                    self.learn_late(bus);
                    unless_lost(bus.quiet().await)?;
                }
            }
        }
        if let Some(exception) = self.absence.last() {
            return Err(WireEnd::Lost(self.gateway_alone(exception)));
        }
        Err(WireEnd::Lost(LinkTrouble::NoAnswer {
            id: self.config.endpoint.id_or_unit(),
        }))
    }

    /// Longest wait for the nth read of the id. Where a late reply is identified by its number, each waits longer than
    /// the one before, so that a slow link is detected.
    fn first_limit(&self, bus: &dyn Bus, bytes: u16, nth: u32) -> Duration {
        let limit = self.reply_limit(bus, bytes);
        if bus.has_numbers() {
            limit.max(REPLY_LIMIT_MIN * 2u32.saturating_pow(nth))
        } else {
            limit * 2
        }
    }

    /// Time limit for the reads after the first answer.
    fn identifies_within(&self) -> Duration {
        let slow = self.slowness.slowest().unwrap_or_default();
        WITHIN.max(slow * QUESTIONS)
    }

    /// Detects how single bytes are packed into words; `None` on wires without words.
    async fn detect_packing(
        &mut self,
        bus: &mut dyn Bus,
        id: Option<&Bytes>,
        until: Moment,
    ) -> Result<Option<BytePacking>, WireEnd> {
        let mut unanswered = 0;
        while unanswered < ATTEMPTS && !self.hurried(until) {
            self.turn(bus).await?;
            let limit = self.reply_limit(bus, 2 * words_per_group(BytePacking::OnePerWord));
            match bus.words(TEMP.address, limit).await {
                Ok(Some(words)) => {
                    self.note_answer();
                    return Ok(judged_packing(id, &words));
                }
                Ok(None) => break,
                Err(error) => match self.unanswered(bus, error).await? {
                    IdentityReply::Refused => break,
                    IdentityReply::Busy => {}
                    _ => unanswered += 1,
                },
            }
        }
        Ok(None)
    }

    async fn detect_quirks(&mut self, bus: &mut dyn Bus, until: Moment) -> Result<Quirks, WireEnd> {
        let baud_code = match self.read_shapes(bus, &BAUD_SHAPES, until).await? {
            IdentityReply::Bytes(bytes) => bytes.first().copied(),
            _ => None,
        };
        // If a range is read in several requests, reading through the gap saves nothing.
        let gap = match bus.cost().turns(GAP_SHAPES[0].len) {
            0 | 1 => self.read_shapes(bus, &GAP_SHAPES, until).await?,
            _ => IdentityReply::Unasked,
        };
        let touch = self.detect_touch(bus, until).await?;
        let gap = match gap {
            IdentityReply::Bytes(_) => Some(GapRead::Through),
            IdentityReply::Refused => Some(GapRead::Split),
            // The serial framing cannot refuse: silence counts as a refusal if the next read is answered.
            IdentityReply::Silent if !bus.has_words() && touch.is_some() => Some(GapRead::Split),
            IdentityReply::Silent | IdentityReply::Busy | IdentityReply::Unasked => None,
        };
        Ok(Quirks {
            baud_code,
            gap,
            touch,
            ..Quirks::default()
        })
    }

    /// Detects the layout of the fingertips. If the first is inconclusive, another is read.
    async fn detect_touch(
        &mut self,
        bus: &mut dyn Bus,
        until: Moment,
    ) -> Result<Option<TouchVariant>, WireEnd> {
        const EMPTY: Option<TouchVariant> = Some(TouchVariant::Unknown(TouchDoubt::Empty));
        let mut first = judged(&self.read_shapes(bus, &TOUCH_SHAPES, until).await?);
        // Pieces from several requests may belong to several measurements, so their checksum proves nothing.
        let pieces = bus.cost().turns(TOUCH_SHAPES[0].len);
        if pieces > 1 && first == Some(TouchVariant::Unknown(TouchDoubt::Check)) {
            first = Some(TouchVariant::Capacitive);
        }
        if first != EMPTY {
            return Ok(first);
        }
        let other = judged(&self.read_shapes(bus, &OTHER_TOUCH_SHAPES, until).await?);
        Ok(other.or(first))
    }

    /// Reads one of the shapes, again if nothing came, and returns the result.
    async fn read_shapes(
        &mut self,
        bus: &mut dyn Bus,
        shapes: &[Span],
        until: Moment,
    ) -> Result<IdentityReply, WireEnd> {
        let mut reply = self.read_shapes_once(bus, shapes, until).await?;
        for _ in 1..ATTEMPTS {
            if matches!(reply, IdentityReply::Silent) {
                reply = self.read_shapes_once(bus, shapes, until).await?;
            }
        }
        while matches!(reply, IdentityReply::Busy) {
            reply = self.read_shapes_once(bus, shapes, until).await?;
        }
        Ok(reply)
    }

    async fn read_shapes_once(
        &mut self,
        bus: &mut dyn Bus,
        shapes: &[Span],
        until: Moment,
    ) -> Result<IdentityReply, WireEnd> {
        if self.hurried(until) {
            return Ok(IdentityReply::Unasked);
        }
        self.turn(bus).await?;
        if self.is_stop_wanted() {
            return Ok(IdentityReply::Unasked);
        }
        let Some(span) = bus.choose(shapes) else {
            return Ok(IdentityReply::Unasked);
        };
        let (limit, asked) = (self.reply_limit(bus, span.len), self.now());
        let wanted = Arc::clone(&self.ends.wanted);
        let urgent = || wanted.borrow().stop;
        match bus.read_unless(span, limit, &urgent).await {
            Ok(Some(bytes)) => {
                self.answered(self.now().since(asked));
                Ok(IdentityReply::Bytes(bytes))
            }
            Ok(None) => Ok(IdentityReply::Unasked),
            Err(error) => self.unanswered(bus, error).await,
        }
    }

    async fn unanswered(
        &mut self,
        bus: &mut dyn Bus,
        error: BusError,
    ) -> Result<IdentityReply, WireEnd> {
        match error {
            BusError::Lost(error) => return Err(WireEnd::Lost(error.into())),
            BusError::Refused { .. } => {
                self.failed(bus, &error).await?;
                return Ok(match self.absence.last() {
                    None => IdentityReply::Refused,
                    // The hand may still answer.
                    Some(_) => IdentityReply::Busy,
                });
            }
            BusError::WrongLength { .. } | BusError::TooLong => self.counters.stats.refusals += 1,
            BusError::Ambiguous => {}
            BusError::Timeout { .. } => self.counters.stats.timeouts += 1,
        }
        self.learn_late(bus);
        // A stop does not wait for the line to settle.
        let stop = stopped(Arc::clone(&self.ends.wanted));
        tokio::select! {
            biased;
            () = stop => {}
            settled = bus.quiet() => unless_lost(settled)?,
        }
        Ok(IdentityReply::Silent)
    }

    /// True if no time is left for another read.
    fn hurried(&self, until: Moment) -> bool {
        self.now() >= until || self.is_stop_wanted()
    }

    fn is_stop_wanted(&self) -> bool {
        self.ends.wanted.borrow().stop || self.has_pending_stop()
    }
}

fn judged_packing(id: Option<&Bytes>, words: &[u16]) -> Option<BytePacking> {
    let at_id = u16::from_le_bytes(*id?.first_chunk()?);
    detect_packing(at_id, words.first_chunk()?)
}

fn judged(reply: &IdentityReply) -> Option<TouchVariant> {
    match reply {
        IdentityReply::Bytes(bytes) => Some(TouchVariant::judge(bytes)),
        IdentityReply::Refused => Some(TouchVariant::Unknown(TouchDoubt::Refused)),
        IdentityReply::Silent | IdentityReply::Busy | IdentityReply::Unasked => None,
    }
}

/// Extracts the id from words that were read before the packing was known, low byte first.
fn first_byte(id: &Bytes, packing: Option<BytePacking>) -> Option<u8> {
    match (packing, id.as_slice()) {
        (Some(BytePacking::HighFirst), [_, high, ..]) => Some(*high),
        (_, [low, ..]) => Some(*low),
        _ => None,
    }
}
