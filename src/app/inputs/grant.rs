//! Who is let move the hand from outside the window, and who is not any more.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::inputs::{FollowOutcome, FollowRun};
use crate::app::running::Running;
use crate::app::settings::Settings;
use crate::hand::{Angle, Dof, PerDof};
use crate::inputs::Offer;
use crate::inputs::follow::HOLDS_AFTER;
use crate::link::{LeaseRefusal, LinkStopper, Owner};
use crate::record::{ArmRefusal, Disarmed};
use crate::tasks::follow::{FollowEnd, FollowStart, FollowTerms, follow};
use tokio::sync::{mpsc, watch};

/// A source that may move the hand.
struct Granted {
    owner: Owner,
    offers: mpsc::Receiver<Offer>,
    /// The hand that leads, if one does.
    leader: Option<LinkStopper>,
}

impl Granted {
    const fn source(owner: Owner, offers: mpsc::Receiver<Offer>) -> Self {
        Self {
            owner,
            offers,
            leader: None,
        }
    }
}

impl HandState {
    /// Nobody is given the right to move a hand that is being left, under a card, or in a series.
    pub(super) fn may_grant(&self) -> bool {
        self.leaving.is_none() && self.procedure.is_none() && !self.runs_series()
    }

    pub(super) fn grant_stream(&mut self, settings: &Settings, env: &Env) {
        let Some(source) = &self.inputs.stream else {
            return;
        };
        let Some((sender, last)) = self.inputs.stream_view.intake.sender else {
            return;
        };
        if self.now.since(last) < HOLDS_AFTER {
            let granted = Granted::source(Owner::Stream(sender), source.follow());
            self.follow_source(granted, settings, env);
        }
    }

    pub(super) fn grant_pad(&mut self, settings: &Settings, env: &Env) {
        let Some(source) = &self.inputs.pad else {
            return;
        };
        if source.view().name.is_some() {
            let granted = Granted::source(Owner::Gamepad, source.follow());
            self.follow_source(granted, settings, env);
        }
    }

    pub(super) fn grant_dds(&mut self, settings: &Settings, env: &Env) {
        let Some(joined) = &self.inputs.dds else {
            return;
        };
        let last = joined.source.view().sender.map(|(_, last)| last);
        let last = last.filter(|_| joined.others.now().is_none());
        if last.is_some_and(|last| self.now.since(last) < HOLDS_AFTER) {
            let granted = Granted::source(Owner::Dds, joined.source.follow());
            self.follow_source(granted, settings, env);
        }
    }

    /// Lets the hand that is watched lead this one, which it must not follow itself.
    pub(in crate::app) fn grant_mirror(&mut self, settings: &Settings, env: &Env) {
        let Some(mirror) = &self.inputs.mirror else {
            return;
        };
        if mirror.source.view().is_fresh(self.now) {
            let granted = Granted {
                owner: Owner::Mirror,
                offers: mirror.source.follow(),
                leader: Some(mirror.stopper.clone()),
            };
            self.follow_source(granted, settings, env);
        }
    }

    /// Lets this source move the hand; what moved it before does not any more.
    fn follow_source(&mut self, granted: Granted, settings: &Settings, env: &Env) {
        let refusal = self.arm_refusal();
        if !self.may_grant() || refusal.is_some_and(|refusal| refusal != ArmRefusal::LetGo) {
            return;
        }
        if let Some(run) = &mut self.sequence {
            run.leave();
        }
        let Some(open) = &self.open else { return };
        let Granted {
            owner,
            offers,
            leader,
        } = granted;
        let lease = open.link.grant(owner);
        let (terms, watched) = watch::channel(self.follow_terms(settings));
        let start = FollowStart {
            lease,
            terms: watched,
            arm: self.arm_request(),
            seen: self.sample,
            clock: env.clock,
        };
        let link = open.link.clone();
        let task = Running::start(env, |views| async move {
            let end = follow(&link, start, offers, |view| views.tell(view)).await;
            let leader = leader.filter(|_| stops_leader(end));
            FollowOutcome {
                end,
                leader_stopped: leader.is_some_and(|leader| leader.stop_if_moved()),
            }
        });
        self.inputs.follow = Some(FollowRun {
            owner,
            view: None,
            terms,
            task,
        });
    }

    /// Ends whoever moves the hand from outside, for this reason; the hand is stopped.
    pub(in crate::app) fn end_outside(&self, why: Disarmed) {
        let Some(open) = &self.open else { return };
        if let Some(holder) = open.link.status().holder
            && holder.owner.is_outside()
        {
            // One that ended meanwhile has stopped already.
            let _done = open.link.give_back(holder.lease, why);
        }
    }

    pub(super) fn follow_terms(&self, settings: &Settings) -> FollowTerms {
        FollowTerms {
            limits: settings.follow,
            locked: self.joints.map(|joint| joint.locked),
            hold: self.hold_to_run(),
        }
    }

    /// The sliders stand where the source sent the joints.
    pub(super) fn show_sent(&mut self, sent: PerDof<Option<Angle>>) {
        for dof in Dof::ALL {
            if let Some(to) = sent[dof] {
                self.joints[dof].target = Some(to);
                self.steered[dof] = true;
                self.commanded = true;
            }
        }
    }

    /// Who moves the hand from outside this window, if somebody may.
    pub fn outside_owner(&self) -> Option<Owner> {
        let holder = self.link.holder.filter(|_| self.link.state.is_live())?;
        holder.owner.is_outside().then_some(holder.owner)
    }
}

/// True if a hand that was led is lost or stopped, so that the one that leads must not go on alone. One that a person took back, or
/// let another move, may.
const fn stops_leader(end: FollowEnd) -> bool {
    match end {
        FollowEnd::Lease(LeaseRefusal::Ended(why)) => !matches!(why, Disarmed::Person),
        FollowEnd::Hot(_) => true,
        FollowEnd::Lease(LeaseRefusal::Taken(_)) | FollowEnd::Silent | FollowEnd::Gone => false,
    }
}
