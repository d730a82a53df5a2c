//! What the program wants of a session, and the session's ends of the channels between them.

#[cfg(test)]
#[allow(clippy::indexing_slicing, clippy::expect_used, reason = "a test may")]
mod tests;

use crate::hand::{ArmEpoch, Moment, Setpoints};
use crate::link::image::RegisterImage;
use crate::link::lease::{HoldToRun, Lease, LeaseBook, LeaseRefusal, Owner};
use crate::link::poll::plan::{PollPriority, PollRates};
use crate::link::request::Request;
use crate::link::stats::LinkStats;
use crate::link::status::{ArmRequest, LinkStatus};
use crate::link::tap::WireTap;
use crate::record::{ArmRefusal, Disarmed, Record};
use std::sync::Arc;
use tokio::sync::{broadcast, mpsc, oneshot, watch};

/// An arming that was asked for. Dropped without an answer if something else came first.
#[derive(Debug)]
pub(crate) struct AskedArm {
    pub(crate) lease: Lease,
    pub(crate) request: ArmRequest,
    pub(crate) answer: oneshot::Sender<Result<ArmEpoch, ArmRefusal>>,
}

/// What is wanted and the session has not taken yet. One slot, so that nothing queues up, and a stop empties it in the
/// same step.
#[derive(Debug, Default)]
pub(crate) struct PendingControl {
    pub(crate) stop: bool,
    pub(crate) disarm: bool,
    /// Why the hand is to be stopped or disarmed, if that is wanted.
    pub(crate) why: Option<Disarmed>,
    pub(crate) arm: Option<AskedArm>,
    pub(crate) setpoints: Option<Setpoints>,
    /// Another may move the hand from now on: what the one before asked for is dropped.
    pub(crate) handed_over: bool,
    pub(crate) rates: Option<PollRates>,
    pub(crate) closed: bool,
    /// Who may move the hand.
    pub(crate) book: LeaseBook,
    /// Motion passes only until then; it is put off while the user holds what has to be held.
    pub(crate) runs_until: Option<Moment>,
    /// What the user at the window has to hold, whoever moves the hand.
    pub(crate) hold_to_run: HoldToRun,
    /// What is read first while something moves.
    pub(crate) priority: PollPriority,
}

impl PendingControl {
    /// True if anything is wanted at all.
    pub(crate) const fn is_any(&self) -> bool {
        let moves = self.arm.is_some() || self.setpoints.is_some() || self.handed_over;
        self.stop || self.disarm || self.closed || moves || self.rates.is_some()
    }

    /// When motion passes no more, if nobody puts that off.
    pub(crate) fn ends(&self) -> Option<Moment> {
        let ends = [self.runs_until, self.hold_to_run.until()];
        ends.into_iter().flatten().min()
    }

    /// True if nothing may move now, because what has to be held is not.
    pub(crate) fn is_let_go(&self, now: Moment) -> bool {
        self.ends().is_some_and(|end| end <= now)
    }

    /// Gives out what is wanted; what outlasts it stays.
    pub(crate) fn take(&mut self) -> Self {
        let rest = Self {
            rates: None,
            ..self.lasting()
        };
        std::mem::replace(self, rest)
    }

    /// What outlasts a lost link.
    pub(crate) fn lasting(&self) -> Self {
        Self {
            closed: self.closed,
            rates: self.rates,
            book: self.book,
            runs_until: self.runs_until,
            hold_to_run: self.hold_to_run,
            priority: self.priority,
            ..Self::default()
        }
    }

    /// The user grants the right to move the hand. Nothing of the one before is sent any more.
    pub(crate) fn grant(&mut self, owner: Owner) -> Lease {
        self.forget_motion();
        self.handed_over = true;
        self.runs_until = None;
        self.book.grant(owner)
    }

    /// Stops the hand before anything else.
    pub(crate) fn stop(&mut self, why: Disarmed) {
        self.stop = true;
        self.why.get_or_insert(why);
        self.forget_motion();
    }

    /// Lets no setpoint pass any more.
    pub(crate) fn disarm(&mut self, why: Disarmed) {
        self.disarm = true;
        self.why.get_or_insert(why);
        self.forget_motion();
    }

    /// Wants this under a lease, if it holds.
    pub(crate) fn under(
        &mut self,
        lease: Lease,
        want: impl FnOnce(&mut Self),
    ) -> Result<(), LeaseRefusal> {
        self.book.check(lease)?;
        want(self);
        Ok(())
    }

    /// Puts newer setpoints over older ones.
    pub(crate) fn set(&mut self, setpoints: &Setpoints) {
        match &mut self.setpoints {
            Some(older) => older.merge(setpoints),
            none => *none = Some(*setpoints),
        }
    }

    fn forget_motion(&mut self) {
        self.arm = None;
        self.setpoints = None;
    }
}

/// The session's ends of what the handle holds.
pub(crate) struct Ends {
    pub(crate) wanted: Arc<watch::Sender<PendingControl>>,
    pub(crate) requests: mpsc::Receiver<Request>,
    pub(crate) records: broadcast::Sender<Record>,
    pub(crate) status: watch::Sender<LinkStatus>,
    pub(crate) stats: watch::Sender<LinkStats>,
    pub(crate) image: watch::Sender<RegisterImage>,
    pub(crate) tap: WireTap,
}
