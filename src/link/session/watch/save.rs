//! One SAVE at a time, and what is known of it: which late frame is whose, how long is listened, when the next may go out.
//! Pure: moments and frames come in, the next step and a verdict go out.

use crate::codec::rs485::SaveResult;
use crate::hand::{Moment, Refusal};
use crate::link::bus::ResultFrame;
use crate::record::{SaveDoubt, Saved};
use std::time::Duration;

/// From SAVE until its result is given up (manual 2.2.2 says about one second; protocol choice 8).
pub(crate) const RESULT_TIMEOUT: Duration = Duration::from_secs(3);
/// Where no result frame exists: time in which the hand writes its flash and is not asked anything.
pub(crate) const FLASH_TAKES: Duration = Duration::from_millis(1200);
/// A result frame up to this long after a SAVE is that one's, or its double. Only then the next may go out.
pub(crate) const CLAIM_DURATION: Duration = Duration::from_secs(6);

/// How the write of SAVE itself ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Ack {
    Acknowledged,
    Unanswered,
    Refused { reason: Refusal },
}

/// What is to be done now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Next {
    /// Leave the line to the hand until then.
    Listen { until: Moment },
    /// Read the parameters and compare.
    ReadBack,
    /// It is over.
    Done(Saved),
}

/// The SAVE under way, or the last one.
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
    /// Whether a SAVE may go out now; else how long it has to wait.
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

    /// SAVE goes out now.
    pub(crate) fn send(&mut self, now: Moment, frame: ResultFrame) {
        self.sent = Some(now);
        self.open = Some(OpenSave {
            at: now,
            frame,
            ack: Ack::Unanswered,
            end: None,
        });
    }

    /// How the write ended.
    pub(crate) fn written(&mut self, ack: Ack) {
        let Some(open) = &mut self.open else {
            return;
        };
        if let Ack::Refused { reason } = &ack {
            open.end.get_or_insert(Saved::Refused { reason: *reason });
        }
        open.ack = ack;
    }

    /// A result frame came. Without a SAVE under way it is nobody's.
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

    /// The parameters were read back: the same as before, or not.
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

    /// The link was lost; what is known then, if a SAVE was under way.
    pub(crate) fn lost(&mut self) -> Option<Saved> {
        let open = self.open.take()?;
        let why = SaveDoubt::LinkLost;
        Some(open.end.unwrap_or(Saved::Unknown { why }))
    }

    /// What is to be done now. Over means over: later frames are nobody's.
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
