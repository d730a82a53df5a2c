//! Opening a hand, leaving it, and going where it is found: what belongs to one connection ends with it.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::open::{Leaving, OpenLink};
use crate::app::notices::{NoticeKind, Notices};
use crate::hand::Moment;
use crate::history::History;
use crate::link::{self, LinkConfig, LinkStatus, PollPriority, PollRates, Traffic};
use crate::record::{Hold, LinkState, Rest};
use crate::transport::Endpoint;
use std::sync::Arc;
use std::time::Duration;

/// A hand that was told to hold gets this long to show that it rests, before its link is closed anyway: the time after
/// which the link itself gives the alarm, and a little.
pub(crate) const REST_WITHIN: Duration = Duration::from_millis(600);

impl HandState {
    /// Leaves the hand. One that may be moving is told to hold first and gets time to.
    pub(crate) fn leave(&mut self, to: Option<Endpoint>, env: &Env, notices: &mut Notices) {
        let now = self.now;
        if let Some(leaving) = &mut self.leaving {
            leaving.to = to;
        } else if self.may_move() {
            self.stop(notices);
            self.leaving = Some(Leaving { to, told: now });
        } else {
            self.go(to, env, notices);
        }
    }

    /// Goes on once a hand that was told to hold rests, or had its time.
    pub(crate) fn go_on_leaving(&mut self, env: &Env, notices: &mut Notices) {
        let told = self.leaving.as_ref().map(|leaving| leaving.told);
        let is_due = |told: Moment| self.now.since(told) >= REST_WITHIN || self.is_held(told);
        if told.is_some_and(is_due)
            && let Some(leaving) = self.leaving.take()
        {
            self.go(leaving.to, env, notices);
        }
    }

    /// Opens another hand, or none, at once.
    pub(crate) fn go(&mut self, to: Option<Endpoint>, env: &Env, notices: &mut Notices) {
        // The old link goes first: a serial port has room for one.
        self.replace(None, None, notices);
        let Some(endpoint) = to else { return };
        let config = LinkConfig {
            endpoint: endpoint.clone(),
            rates: PollRates::default(),
            clock: env.clock,
            dial: Arc::clone(&env.dial),
            wake: Arc::clone(&env.wake),
        };
        let open = OpenLink::new(link::open(config, &env.runtime));
        self.replace(Some(endpoint), Some(open), notices);
    }

    /// Puts another hand in place of the one before, or none. Nothing of the old one is taken for the new one's; what is
    /// done under a card goes along.
    pub(crate) fn replace(
        &mut self,
        endpoint: Option<Endpoint>,
        open: Option<OpenLink>,
        notices: &mut Notices,
    ) {
        let former = self.name();
        self.recorder.another_hand(&self.history, &former, self.now);
        let is_other = endpoint.is_some() && endpoint != self.measured;
        let before = std::mem::take(self);
        *self = Self {
            now: before.now,
            label: before.label,
            side: before.side,
            is_removed: before.is_removed,
            traffic: match (&open, &endpoint) {
                (Some(open), Some(endpoint)) => Traffic::of(open.link.tap(), endpoint),
                _ => Traffic::default(),
            },
            link: LinkStatus {
                since: before.now,
                ..LinkStatus::default()
            },
            // An id that was changed under a card makes no other hand.
            history: if is_other && before.procedure.is_none() {
                History::new()
            } else {
                before.history
            },
            measured: if is_other {
                endpoint.clone()
            } else {
                before.measured
            },
            joints: before.joints,
            recorder: before.recorder,
            procedure: before.procedure,
            requested: before.requested,
            leaving: before.leaving,
            listed: before.listed,
            seen_from: Some(before.now),
            open,
            endpoint,
            ..Self::default()
        };
        self.history.gap(self.now);
        notices.withdraw(|what| matches!(what, NoticeKind::LinkLost(_) | NoticeKind::NoLink(_)));
        self.follow();
    }

    /// Reads this first while something moves.
    pub(crate) fn read_first(&self, priority: PollPriority) {
        if let Some(open) = &self.open {
            open.link.read_first(priority);
        }
    }

    /// True if closing or leaving now could leave a hand in motion that this program set in motion: also where feedback is too old
    /// to tell.
    pub(crate) fn may_move(&self) -> bool {
        let may_still_move = self.commanded && self.link.rest != Rest::Resting;
        let holding = self.link.state == LinkState::Holding;
        self.link.state.is_live() && (self.is_armed() || holding || may_still_move)
    }

    /// True once nothing more can be done for a hand that was told to hold at this moment: it rests, or is gone.
    pub(crate) fn is_held(&self, told: Moment) -> bool {
        let rests = matches!(self.link.hold, Hold::Confirmed { rest, .. } if rest >= told);
        !self.link.state.is_live() || rests
    }
}
