//! Settings, SAVE and reset on the wire: written only at rest, read back, and never talked over. One at a time; a stop passes
//! between any two of its steps. What a late frame means is decided in `save_watch`.

use crate::hand::register::{DEFAULT_FORCE_SET, DEFAULT_SPEED_SET, SAVE};
use crate::hand::{HandCommand, Moment, RegisterWrite, Setting, Span, Writes};
use crate::link::bus::{Bus, BusError};
use crate::link::calibrate::Calibrating;
use crate::link::event::{Outcome, Request, RequestError, Ticket};
use crate::link::handle::Wanted;
use crate::link::save_watch::{Ack, Next, ResultFrame};
use crate::link::session::{End, Session};
use crate::link::settled::{Calibrated, Doubt, NotSent, Reset, SaveDoubt, Saved, Verdict, Written};
use crate::link::status::LinkState;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::sleep_until;

/// Reads that may verify one write: one lost answer must not leave it unverified, and a value that differs is read twice.
const READS: u8 = 3;
/// Other questions asked to get a double of the last answer out of the way.
const CLEARINGS: u8 = 3;
/// What is compared before and after a SAVE on wires without a result frame: the two default groups, side by side.
const PARAMETERS: Span = Span::new(
    DEFAULT_SPEED_SET.address,
    DEFAULT_SPEED_SET.len + DEFAULT_FORCE_SET.len,
);
/// While the line is left to the hand, the session looks around this often.
const LISTEN_FOR: Duration = Duration::from_millis(100);

/// A setting, a SAVE or a reset under way.
pub(crate) struct Settling {
    pub(crate) ticket: Ticket,
    work: Work,
    reads: u8,
    clearings: u8,
}

enum Work {
    Set {
        setting: Setting,
        writes: Writes,
        refused: Option<String>,
        held: Option<Vec<u8>>,
        /// An answer is missing. Over CAN a part of the group may be written and the rest not.
        is_unanswered: bool,
        /// It may be written once more: the same value again does no harm.
        may_repeat: bool,
    },
    Save {
        is_sent: bool,
        before: Option<Vec<u8>>,
    },
    Reset,
    Calibrate(Calibrating),
}

/// How a read ended.
enum Read {
    Bytes(Vec<u8>),
    /// Try again: a stop came between, or the line had to be cleared first.
    Later,
    Failed(Doubt),
}

impl Session {
    /// Takes a request for a setting, or says why not.
    pub(crate) fn take_settling(&mut self, ticket: Ticket, request: Request) {
        let work = match request {
            Request::Set(setting) => Work::Set {
                setting,
                writes: setting.command().writes(),
                refused: None,
                held: None,
                is_unanswered: false,
                may_repeat: true,
            },
            Request::Save => Work::Save {
                is_sent: false,
                before: None,
            },
            Request::Reset => Work::Reset,
            Request::Calibrate => Work::Calibrate(Calibrating::default()),
            Request::Command(_) | Request::Read(_) => return,
        };
        if let Some(why) = self.may_not_settle(&work) {
            let outcome = work.not_sent(why);
            self.answer(ticket, Ok(outcome));
            return;
        }
        self.settling = Some(Settling {
            ticket,
            work,
            reads: READS,
            clearings: CLEARINGS,
        });
    }

    fn may_not_settle(&self, work: &Work) -> Option<NotSent> {
        let now = self.now();
        match self.status.state {
            LinkState::Armed => Some(NotSent::Armed),
            LinkState::Holding => Some(NotSent::Holding),
            _ if matches!(work, Work::Set { .. }) => None,
            _ if self.moving.moves(now) => Some(NotSent::Moving),
            _ => {
                let wait = self.saving.may_send(now).err()?;
                Some(NotSent::TooSoon { wait })
            }
        }
    }

    /// True if the line is left to a hand that saves or calibrates.
    pub(crate) const fn leaves_line(&self) -> bool {
        matches!(
            &self.settling,
            Some(Settling {
                work: Work::Save { is_sent: true, .. }
                    | Work::Calibrate(Calibrating { sent: Some(_), .. }),
                ..
            })
        )
    }

    /// Says whether the line is left to the hand.
    pub(crate) fn tell_line_left(&mut self) {
        let left = self.leaves_line();
        if self.status.line_left != left {
            self.status.line_left = left;
            self.publish();
        }
    }

    /// The next step of what is under way.
    pub(crate) async fn settle(&mut self, bus: &mut Bus) -> Result<(), End> {
        let Some(settling) = self.settling.take() else {
            return Ok(());
        };
        // It stays where a lost link finds it.
        let (work, ticket) = (&settling.work, settling.ticket);
        match work {
            Work::Set { .. } => self.settle_setting(bus, settling).await,
            Work::Save { .. } => self.settle_save(bus, settling).await,
            Work::Reset => {
                let end = self.send_reset(bus, settling).await;
                self.settled(ticket, Outcome::Reset(end?));
                Ok(())
            }
            Work::Calibrate(run) => {
                let run = *run;
                self.settling = Some(settling);
                self.settle_calibration(bus, run).await
            }
        }
    }

    /// What is under way stands so now.
    pub(crate) fn keep_calibrating(&mut self, run: Calibrating) {
        if let Some(Settling {
            work: Work::Calibrate(kept),
            ..
        }) = &mut self.settling
        {
            *kept = run;
        }
    }

    /// What is under way has come to its end.
    pub(crate) fn calibrated(&mut self, calibrated: Calibrated) {
        if let Some(ticket) = self.settling.as_ref().map(|settling| settling.ticket) {
            self.settled(ticket, Outcome::Calibrated(calibrated));
        }
    }

    fn settled(&mut self, ticket: Ticket, outcome: Outcome) {
        self.settling = None;
        self.answer(ticket, Ok(outcome));
    }

    async fn settle_setting(&mut self, bus: &mut Bus, mut now: Settling) -> Result<(), End> {
        let Work::Set {
            setting,
            writes,
            refused,
            held,
            is_unanswered,
            may_repeat,
        } = &mut now.work
        else {
            return Ok(());
        };
        let setting = *setting;
        if let Some(write) = writes.pop_at(0) {
            match self.write(bus, &write).await {
                Ok(()) => self.settling = Some(now),
                Err(error) => {
                    match &error {
                        BusError::Refused { reason } => {
                            refused.get_or_insert_with(|| reason.clone());
                        }
                        _ => *is_unanswered = true,
                    }
                    self.settling = Some(now);
                    self.failed(bus, &error).await?;
                }
            }
            return Ok(());
        }
        let (refused, held) = (refused.clone(), held.clone());
        let repeats = *is_unanswered && *may_repeat;
        let (reads_left, ticket) = (now.reads, now.ticket);
        let span = setting.span();
        let written = match self.read_settled(bus, now, span).await? {
            Read::Later => return Ok(()),
            Read::Failed(why) => Written {
                span,
                verdict: Verdict::Unverified { why },
                holds: None,
            },
            Read::Bytes(bytes) if setting.is_held_by(&bytes) => Written {
                span,
                verdict: Verdict::Applied,
                holds: Some(bytes),
            },
            // What a line without a check worth the name gave once is asked for again.
            Read::Bytes(bytes) if held.as_ref() != Some(&bytes) && reads_left > 1 => {
                if let Some(Settling {
                    work: Work::Set { held, .. },
                    ..
                }) = &mut self.settling
                {
                    *held = Some(bytes);
                }
                return Ok(());
            }
            Read::Bytes(_) if repeats => {
                self.repeat(setting);
                return Ok(());
            }
            Read::Bytes(bytes) => Written {
                span,
                verdict: refused.map_or(Verdict::Differs, |reason| Verdict::Refused { reason }),
                holds: Some(bytes),
            },
        };
        self.settled(ticket, Outcome::Written(written));
        Ok(())
    }

    /// The hand was seen to hold something else, and an answer was missing: from the beginning, for the last time.
    fn repeat(&mut self, setting: Setting) {
        if let Some(settling) = &mut self.settling {
            settling.reads = READS;
            settling.work = Work::Set {
                setting,
                writes: setting.command().writes(),
                refused: None,
                held: None,
                is_unanswered: false,
                may_repeat: false,
            };
        }
    }

    async fn settle_save(&mut self, bus: &mut Bus, mut now: Settling) -> Result<(), End> {
        let ticket = now.ticket;
        let Work::Save { is_sent, before } = &mut now.work else {
            return Ok(());
        };
        if !*is_sent {
            let frame = bus.save_result_frame();
            if before.is_none() && frame == ResultFrame::None {
                // Without a picture from before there is nothing to compare with, and that is said at the end.
                match self.read_settled(bus, now, PARAMETERS).await? {
                    Read::Bytes(bytes) => self.note_before(bytes),
                    Read::Failed(_) => self.note_before(Vec::new()),
                    Read::Later => {}
                }
                return Ok(());
            }
            *is_sent = true;
            now.reads = READS;
            self.settling = Some(now);
            // What came until now is of an earlier one.
            while bus.take_save_result().is_some() {}
            self.saving.send(self.now(), frame);
            return self.send_save(bus).await;
        }
        let before = before.clone();
        while let Some(result) = bus.take_save_result() {
            self.saving.result(result);
        }
        match self.saving.next(self.now()) {
            Next::Done(saved) => self.settled(ticket, Outcome::Saved(saved)),
            Next::Listen { until } => {
                self.settling = Some(now);
                self.listen(bus, until).await?;
            }
            Next::ReadBack => match self.read_settled(bus, now, PARAMETERS).await? {
                Read::Later => {}
                Read::Failed(_) => self.saving.read_back(false),
                Read::Bytes(bytes) => self.saving.read_back(before == Some(bytes)),
            },
        }
        Ok(())
    }

    fn note_before(&mut self, bytes: Vec<u8>) {
        if let Some(Settling {
            work: Work::Save { before, .. },
            ..
        }) = &mut self.settling
        {
            *before = Some(bytes);
        }
    }

    async fn send_save(&mut self, bus: &mut Bus) -> Result<(), End> {
        let sent = self.trigger(bus, &HandCommand::Save).await;
        self.saving.written(match &sent {
            Ok(()) => Ack::Acknowledged,
            Err(BusError::Refused { reason }) => Ack::Refused {
                reason: reason.clone(),
            },
            Err(_) => Ack::Unanswered,
        });
        match sent {
            Err(BusError::Lost(error)) => Err(End::Lost(error.into())),
            // A hand that writes its flash may be mute: that is no silence to be counted.
            _ => Ok(()),
        }
    }

    async fn send_reset(&mut self, bus: &mut Bus, now: Settling) -> Result<Reset, End> {
        self.settling = Some(now);
        match self.trigger(bus, &HandCommand::ResetParameters).await {
            Ok(()) => Ok(Reset::Acknowledged),
            Err(BusError::Refused { reason }) => Ok(Reset::Refused { reason }),
            Err(BusError::Lost(error)) => Err(End::Lost(error.into())),
            Err(_) => Ok(Reset::Unanswered),
        }
    }

    pub(crate) async fn trigger(
        &mut self,
        bus: &mut Bus,
        command: &HandCommand,
    ) -> Result<(), BusError> {
        let write: Option<RegisterWrite> = command.writes().into_iter().next();
        match write {
            Some(write) => self.write(bus, &write).await,
            None => Err(BusError::TooLong),
        }
    }

    /// Leaves the line to the hand: takes what comes, asks nothing, and ends early for a wish of the window.
    pub(crate) async fn listen(&mut self, bus: &mut Bus, until: Moment) -> Result<(), End> {
        let now = self.now();
        let until = until.min(now.plus(LISTEN_FOR));
        // A stop that feedback does not confirm goes on meanwhile.
        let until = self
            .motion
            .next_send(now)
            .map_or(until, |hold| until.min(hold));
        let mut wanted = self.ends.wanted.subscribe();
        let over = sleep_until(self.config.clock.instant(until));
        tokio::select! {
            biased;
            _ = wanted.wait_for(Wanted::is_any) => Ok(()),
            heard = bus.listen() => match heard {
                Err(BusError::Lost(error)) => Err(End::Lost(error.into())),
                _ => Ok(()),
            },
            () = over => Ok(()),
        }
    }

    /// Reads a group in a form that no late reply can answer. What is under way stays so, with one read less.
    async fn read_settled(
        &mut self,
        bus: &mut Bus,
        mut now: Settling,
        span: Span,
    ) -> Result<Read, End> {
        // The same bytes and a few more: each length is another question.
        let shapes = [0, 2, 4, 6].map(|more| Span::new(span.address, span.len + more));
        let Some(shape) = bus.choose(&shapes) else {
            let is_cleared = now.clearings > 0;
            now.clearings = now.clearings.saturating_sub(1);
            self.settling = Some(now);
            if !is_cleared {
                return Ok(Read::Failed(Doubt::Ambiguous));
            }
            self.poll_motion(bus).await?;
            return Ok(Read::Later);
        };
        let limit = self.reply_limit(bus, shape.len);
        let asked = self.now();
        let wanted = Arc::clone(&self.ends.wanted);
        let read = bus.read_unless(shape, limit, || wanted.borrow().stop).await;
        let took = self.now().since(asked);
        match read {
            Ok(None) => {
                self.settling = Some(now);
                Ok(Read::Later)
            }
            Ok(Some(bytes)) => {
                self.answered(took);
                now.reads = now.reads.saturating_sub(1);
                self.settling = Some(now);
                let bytes = shape.slice(&bytes, span).map(<[u8]>::to_vec);
                Ok(bytes.map_or(Read::Failed(Doubt::NotReadBack), Read::Bytes))
            }
            Err(error) => {
                now.reads = now.reads.saturating_sub(1);
                let is_last = now.reads == 0;
                self.settling = Some(now);
                self.failed(bus, &error).await?;
                Ok(if is_last {
                    Read::Failed(Doubt::NotReadBack)
                } else {
                    Read::Later
                })
            }
        }
    }

    /// The link is gone: what is known of a setting, SAVE or reset that was under way.
    pub(crate) fn lose_settling(&mut self) {
        let Some(settling) = self.settling.take() else {
            return;
        };
        let saved = self.saving.lost();
        let result = match settling.work {
            Work::Set { setting, .. } => Ok(Outcome::Written(Written {
                span: setting.span(),
                verdict: Verdict::Unverified {
                    why: Doubt::LinkLost,
                },
                holds: None,
            })),
            Work::Save { .. } => saved.map(Outcome::Saved).ok_or(RequestError::LinkLost),
            Work::Reset => Ok(Outcome::Reset(Reset::Unanswered)),
            Work::Calibrate(_) => Ok(Outcome::Calibrated(Calibrated::Unknown {
                why: SaveDoubt::LinkLost,
            })),
        };
        self.answer(settling.ticket, result);
    }

    /// True if a read of this run could be answered by the result of a SAVE.
    pub(crate) fn looks_like_save(&self, span: Span) -> bool {
        span == SAVE.span() && self.saving.is_claimed(self.now())
    }
}

impl Work {
    fn not_sent(&self, why: NotSent) -> Outcome {
        match self {
            Self::Set { setting, .. } => Outcome::Written(Written {
                span: setting.span(),
                verdict: Verdict::NotSent(why),
                holds: None,
            }),
            Self::Save { .. } => Outcome::Saved(Saved::NotSent(why)),
            Self::Reset => Outcome::Reset(Reset::NotSent(why)),
            Self::Calibrate(_) => Outcome::Calibrated(Calibrated::NotSent(why)),
        }
    }
}
