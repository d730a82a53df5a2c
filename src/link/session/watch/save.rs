//! State of a SAVE: which late frame belongs to it, how long to listen, and when the next may be sent. Pure: moments
//! and frames in, the next step and a verdict out.

use crate::codec::rs485::SaveResult;
use crate::hand::{Moment, Refusal};
use crate::link::bus::ResultFrame;
use crate::record::{SaveDoubt, Saved};
use std::time::Duration;

/// Time from a SAVE until its result is given up (manual 2.2.2 gives about one second; protocol choice 8).
pub(crate) const RESULT_TIMEOUT: Duration = Duration::from_secs(3);
/// Time in which the hand writes its flash and is not polled, where no result frame exists.
pub(crate) const FLASH_TAKES: Duration = Duration::from_millis(1200);
/// A result frame up to this long after a SAVE belongs to it, or duplicates its result. The next may be sent only after that.
pub(crate) const CLAIM_DURATION: Duration = Duration::from_secs(6);

/// Result of the SAVE write itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Ack {
    Acknowledged,
    Unanswered,
    Refused { reason: Refusal },
}

/// The next step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Next {
    /// Send nothing until then.
    Listen { until: Moment },
    /// Read the parameters and compare.
    ReadBack,
    /// The SAVE is over.
    Done(Saved),
}

/// The SAVE in progress, or the last one.
#[derive(Debug, Default)]
pub(crate) struct SaveWatch {
    sent: Option<Moment>,
    open: Option<OpenSave>,
}

#[derive(Debug)]
struct OpenSave {
    at: Moment,
    frame: ResultFrame,
    ack: Ack,
    end: Option<Saved>,
}

impl SaveWatch {
    /// Checks whether a SAVE may be sent now.
    ///
    /// # Errors
    /// The time to wait otherwise.
    pub(crate) fn may_send(&self, now: Moment) -> Result<(), Duration> {
        let claimed = self.sent.map(|sent| sent.plus(CLAIM_DURATION));
        match claimed.filter(|until| *until > now) {
            Some(until) => Err(until.since(now)),
            None => Ok(()),
        }
    }

    /// True while a frame that looks like the result of a SAVE may still come.
    pub(crate) fn is_claimed(&self, now: Moment) -> bool {
        self.may_send(now).is_err()
    }

    /// Records that a SAVE is sent now.
    pub(crate) fn send(&mut self, now: Moment, frame: ResultFrame) {
        self.sent = Some(now);
        self.open = Some(OpenSave {
            at: now,
            frame,
            ack: Ack::Unanswered,
            end: None,
        });
    }

    /// Records the result of the write.
    pub(crate) fn written(&mut self, ack: Ack) {
        let Some(open) = &mut self.open else {
            return;
        };
        if let Ack::Refused { reason } = &ack {
            open.end.get_or_insert(Saved::Refused { reason: *reason });
        }
        open.ack = ack;
    }

    /// Applies a result frame, which is ignored if no SAVE is in progress.
    pub(crate) fn result(&mut self, result: SaveResult) {
        let Some(open) = &mut self.open else {
            return;
        };
        if open.frame == ResultFrame::None {
            return;
        }
        open.end.get_or_insert(match result {
            SaveResult::Ok => Saved::Confirmed,
            SaveResult::Failed => Saved::Failed { code: 0xFF },
            SaveResult::Other(code) => Saved::Failed { code },
        });
    }

    /// Records that the parameters were read back, the same as before or not.
    pub(crate) fn read_back(&mut self, same: bool) {
        let Some(open) = &mut self.open else {
            return;
        };
        let doubt = if open.ack == Ack::Acknowledged {
            SaveDoubt::NotReadBack
        } else {
            SaveDoubt::Unanswered
        };
        open.end
            .get_or_insert(if same && open.ack == Ack::Acknowledged {
                Saved::ReadBack
            } else {
                Saved::Unknown { why: doubt }
            });
    }

    /// Ends a SAVE on a lost link; returns what is known of it, if one was in progress.
    pub(crate) fn lost(&mut self) -> Option<Saved> {
        let open = self.open.take()?;
        let why = SaveDoubt::LinkLost;
        Some(open.end.unwrap_or(Saved::Unknown { why }))
    }

    /// The next step. Frames after the end are ignored.
    pub(crate) fn next(&mut self, now: Moment) -> Next {
        let Some(open) = &mut self.open else {
            let why = SaveDoubt::LinkLost;
            return Next::Done(Saved::Unknown { why });
        };
        if let Some(end) = open.end.take() {
            self.open = None;
            return Next::Done(end);
        }
        let until = open.at.plus(match open.frame {
            ResultFrame::Comes => RESULT_TIMEOUT,
            ResultFrame::None => FLASH_TAKES,
        });
        if now < until {
            return Next::Listen { until };
        }
        if open.frame == ResultFrame::None {
            return Next::ReadBack;
        }
        let why = if open.ack == Ack::Acknowledged {
            SaveDoubt::NoResult
        } else {
            SaveDoubt::Unanswered
        };
        self.open = None;
        Next::Done(Saved::Unknown { why })
    }
}
