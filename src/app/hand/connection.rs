//! Opening a hand, leaving it, and going where it is found: what belongs to one connection ends with it.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::open::{Leaving, Open};
use crate::app::notices::{NoticeKind, Notices};
use crate::app::params::state::ParamsState;
use crate::app::readings::faults::FaultList;
use crate::app::readings::pace::Pace;
use crate::app::readings::peaks::ForcePeaks;
use crate::app::readings::tare::Tare;
use crate::hand::{HandSample, Moment, PerDof, PerFinger};
use crate::history::History;
use crate::link::{self, First, LinkConfig, LinkStats, LinkStatus, PollRates, Traffic};
use crate::record::{Hold, LinkState};
use crate::transport::Endpoint;
use std::sync::Arc;
use std::time::Duration;

/// A hand that was told to hold gets this long to show that it rests, before its link is closed anyway: the time after
/// which the link itself gives the alarm, and a little.
pub(crate) const REST_WITHIN: Duration = Duration::from_millis(600);

impl HandState {
    /// Leaves the hand. One that may be moving is told to hold first and gets time to.
    pub(crate) fn leave(
        &mut self,
        to: Option<Endpoint>,
        env: &Env,
        notices: &mut Notices,
        now: Moment,
    ) {
        if let Some(leaving) = &mut self.leaving {
            leaving.to = to;
        } else if self.may_move() {
            self.stop(notices, now);
            self.leaving = Some(Leaving { to, told: now });
        } else {
            self.go(to, env, notices, now);
        }
    }

    /// Goes on once a hand that was told to hold rests, or had its time.
    pub(crate) fn go_on_leaving(&mut self, env: &Env, notices: &mut Notices, now: Moment) {
        let told = self.leaving.as_ref().map(|leaving| leaving.told);
        let is_due = |told: Moment| now.since(told) >= REST_WITHIN || self.is_held(told);
        if told.is_some_and(is_due)
            && let Some(leaving) = self.leaving.take()
        {
            self.go(leaving.to, env, notices, now);
        }
    }

    /// Opens another hand, or none, at once.
    pub(crate) fn go(
        &mut self,
        to: Option<Endpoint>,
        env: &Env,
        notices: &mut Notices,
        now: Moment,
    ) {
        // The old link goes first: a serial port has room for one.
        self.replace(None, None, notices, now);
        let Some(endpoint) = to else { return };
        let config = LinkConfig {
            endpoint: endpoint.clone(),
            rates: PollRates::default(),
            clock: env.clock,
            dial: Arc::clone(&env.dial),
            wake: Arc::clone(&env.wake),
        };
        let open = Open::new(link::open(config, &env.runtime));
        self.replace(Some(endpoint), Some(open), notices, now);
    }

    /// Puts another hand in place of the one before, or none. Nothing of the old one is taken for the new one's; what is
    /// done under a card goes along.
    pub(crate) fn replace(
        &mut self,
        endpoint: Option<Endpoint>,
        open: Option<Open>,
        notices: &mut Notices,
        now: Moment,
    ) {
        self.traffic = match (&open, &endpoint) {
            (Some(open), Some(endpoint)) => Traffic::of(open.link.tap(), endpoint),
            _ => Traffic::default(),
        };
        let former = self.name();
        self.recorder.another_hand(&self.history, &former, now);
        let is_other = endpoint.is_some() && endpoint != self.measured;
        // An id that was changed under a card makes no other hand.
        if is_other && self.procedure.is_none() {
            self.history = History::new();
        }
        if is_other {
            self.measured.clone_from(&endpoint);
        }
        self.open = open;
        self.endpoint = endpoint;
        self.link = LinkStatus {
            since: now,
            ..LinkStatus::default()
        };
        self.stats = LinkStats::default();
        self.sample = HandSample::default();
        self.pace = Pace::default();
        self.tip_pace = PerFinger::splat(self.pace);
        self.tare = Tare::default();
        self.peaks = ForcePeaks::default();
        self.sheet = None;
        self.faults = FaultList::default();
        self.gestures.another_hand();
        self.sequence = None;
        self.series = None;
        self.asked.clear();
        // What is staged was meant for the old one.
        self.params = ParamsState::default();
        self.history.gap(now);
        notices.withdraw(|what| matches!(what, NoticeKind::LinkLost(_) | NoticeKind::NoLink(_)));
        self.following = PerDof::splat(true);
        self.disarmed_at = None;
        self.commanded = false;
        self.seen_from = Some(now);
        self.was_live = false;
        self.follow();
    }

    /// Reads this first while something moves.
    pub(crate) fn read_first(&self, first: First) {
        if let Some(open) = &self.open {
            open.link.read_first(first);
        }
    }

    /// True if closing or leaving now could leave a hand in motion that this program set in motion.
    pub(crate) fn may_move(&self) -> bool {
        let moves = self
            .sample
            .status
            .is_some_and(|all| all.value.iter().any(|(_, status)| status.is_moving()));
        let holding = self.link.state == LinkState::Holding;
        self.link.state.is_live() && (self.is_armed() || holding || self.commanded && moves)
    }

    /// True once nothing more can be done for a hand that was told to hold at this moment: it rests, or is gone.
    pub(crate) fn is_held(&self, told: Moment) -> bool {
        let rests = matches!(self.link.hold, Hold::Confirmed { rest, .. } if rest >= told);
        !self.link.state.is_live() || rests
    }
}
