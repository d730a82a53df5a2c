//! Pending control requests to a session, and the session's ends of the channels.

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

/// A requested arming. Dropped without a reply if something else replaced it.
#[derive(Debug)]
pub(crate) struct ArmCommand {
    pub(crate) lease: Lease,
    pub(crate) request: ArmRequest,
    pub(crate) answer: oneshot::Sender<Result<ArmEpoch, ArmRefusal>>,
}

/// Control requests that the session has not applied yet. One slot, so that nothing queues up, and a stop clears it in
/// the same step.
#[derive(Debug, Default)]
pub(crate) struct PendingControl {
    pub(crate) stop: bool,
    pub(crate) disarm: bool,
    /// Reason of the requested stop or disarm.
    pub(crate) why: Option<Disarmed>,
    pub(crate) arm: Option<ArmCommand>,
    pub(crate) setpoints: Option<Setpoints>,
    /// A new lease was granted: the previous owner's requests are dropped.
    pub(crate) handed_over: bool,
    pub(crate) rates: Option<PollRates>,
    pub(crate) closed: bool,
    /// The lease of the hand.
    pub(crate) book: LeaseBook,
    /// Motion ends at this time; extended while the user holds the key.
    pub(crate) runs_until: Option<Moment>,
    /// Hold-to-run mode set in the window; it applies to every owner.
    pub(crate) hold_to_run: HoldToRun,
    /// Reads to prefer while the hand moves.
    pub(crate) priority: PollPriority,
}

impl PendingControl {
    /// True if any request is pending.
    pub(crate) const fn is_any(&self) -> bool {
        let moves = self.arm.is_some() || self.setpoints.is_some() || self.handed_over;
        self.stop || self.disarm || self.closed || moves || self.rates.is_some()
    }

    /// Time at which motion ends unless it is extended; `None` if unlimited.
    pub(crate) fn ends(&self) -> Option<Moment> {
        let ends = [self.runs_until, self.hold_to_run.until()];
        ends.into_iter().flatten().min()
    }

    /// True if motion is disabled because the key is not held.
    pub(crate) fn is_let_go(&self, now: Moment) -> bool {
        self.ends().is_some_and(|end| end <= now)
    }

    /// Takes the pending requests and keeps the persistent ones.
    pub(crate) fn take(&mut self) -> Self {
        let rest = Self {
            rates: None,
            ..self.lasting()
        };
        std::mem::replace(self, rest)
    }

    /// The part that survives a lost link.
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

    /// Grants a lease and drops the previous owner's requests.
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

    /// Requests a disarm and drops pending setpoints.
    pub(crate) fn disarm(&mut self, why: Disarmed) {
        self.disarm = true;
        self.why.get_or_insert(why);
        self.forget_motion();
    }

    /// Applies a change under a lease, if it is valid.
    pub(crate) fn under(
        &mut self,
        lease: Lease,
        want: impl FnOnce(&mut Self),
    ) -> Result<(), LeaseRefusal> {
        self.book.check(lease)?;
        want(self);
        Ok(())
    }

    /// Merges newer setpoints over older ones.
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

/// The session's ends of the handle's channels.
pub(crate) struct SessionChannels {
    pub(crate) wanted: Arc<watch::Sender<PendingControl>>,
    pub(crate) requests: mpsc::Receiver<Request>,
    pub(crate) records: broadcast::Sender<Record>,
    pub(crate) status: watch::Sender<LinkStatus>,
    pub(crate) stats: watch::Sender<LinkStats>,
    pub(crate) image: watch::Sender<RegisterImage>,
    pub(crate) tap: WireTap,
}
