//! What a person asks of the hand, and the rules that stand before it. Opens no link, writes no file.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::joint::Preset;
use crate::app::notices::{NoticeKind, Notices};
use crate::hand::{Angle, Dof, Force, PerDof, Setpoints, Speed, Target};
use crate::history::MarkKind;
use crate::link::ArmRequest;
use crate::poses::player::{PlayMode, PlayPlan};
use crate::record::LinkState;
use crate::trials::Abort;

impl HandState {
    /// Holds now. Works in every state; whatever was armed is not any more, at once. Without a live link it says that
    /// nothing could be sent.
    pub(crate) fn stop(&mut self, notices: &mut Notices) {
        match &self.open {
            Some(open) if self.link.state.is_live() => open.link.stop(),
            _ => {
                notices.push(self.now, NoticeKind::StopNotSent);
                self.history.mark(self.now, MarkKind::StopNotSent);
            }
        }
        if let Some(run) = &mut self.series {
            run.end(Abort::Person);
        }
        self.mark_disarmed(LinkState::Holding);
    }

    /// Lets no setpoint pass any more. The hand keeps what it was told.
    pub(crate) fn disarm(&mut self) {
        if let Some(open) = &self.open {
            open.link.disarm();
        }
        self.mark_disarmed(LinkState::Monitoring);
    }

    fn mark_disarmed(&mut self, state: LinkState) {
        self.disarmed_at = Some(self.now);
        self.held.forget_press();
        if self.is_armed() {
            self.link.state = state;
        }
        self.link.armed = None;
        self.follow();
    }

    /// Asks the link to let setpoints pass, if the pose is known and nothing speaks against it.
    pub(crate) fn arm(&mut self, notices: &mut Notices) {
        // Nor is one armed that is being left, or that something is done to under a card.
        if self.is_armed() || self.leaving.is_some() || self.procedure.is_some() {
            return;
        }
        if let Some(reason) = self.arm_refusal() {
            notices.push(self.now, NoticeKind::ArmRefused(reason));
            return;
        }
        let request = self.arm_request();
        if let Some(open) = &mut self.open {
            let lease = open.take_lease();
            // Just granted: it holds.
            let _asked = open.link.arm(lease, request);
        }
    }

    /// The limits that a person set.
    pub(crate) fn arm_request(&self) -> ArmRequest {
        ArmRequest {
            speed: self.joints.map(|joint| joint.speed),
            force: self.joints.map(|joint| joint.force),
        }
    }

    /// Where a joint should go. Nothing happens unless armed and not locked.
    pub(crate) fn target(&mut self, dof: Dof, angle: Angle) {
        if !self.is_free(dof) {
            return;
        }
        self.take_over();
        self.joints[dof].target = Some(angle);
        self.steered[dof] = true;
        self.send(|setpoints| setpoints.angle[dof] = Some(Target::Go(angle)));
    }

    /// Force threshold of a joint: kept, and sent if armed and not locked.
    pub(crate) fn force(&mut self, dof: Dof, force: Force) {
        self.joints[dof].force = force;
        if self.is_free(dof) {
            self.send(|setpoints| setpoints.force[dof] = Some(force));
        }
    }

    /// Speed of a joint: kept, and sent if armed and not locked.
    pub(crate) fn speed(&mut self, dof: Dof, speed: Speed) {
        self.joints[dof].speed = speed;
        if self.is_free(dof) {
            self.send(|setpoints| setpoints.speed[dof] = Some(speed));
        }
    }

    /// Leaves a joint alone, or not. Its slider stands at the actual angle until it is touched again; force and
    /// speed that were changed meanwhile go out when it is free again.
    pub(crate) fn lock(&mut self, dof: Dof, locked: bool) {
        let joint = &mut self.joints[dof];
        let freed = joint.locked && !locked;
        joint.locked = locked;
        let (force, speed) = (joint.force, joint.speed);
        self.steered[dof] = false;
        self.follow();
        self.tell_locks();
        if freed && self.is_free(dof) {
            self.send(|setpoints| {
                setpoints.force[dof] = Some(force);
                setpoints.speed[dof] = Some(speed);
            });
        }
    }

    /// All joints that are not locked to where the preset has them, in one step, at the speeds that are set.
    pub(crate) fn preset(&mut self, preset: Preset) {
        self.go_to(|setpoints| {
            setpoints.angle = PerDof::from_fn(|dof| preset.angle(dof).map(Target::Go));
        });
    }

    /// Takes a pose: speed and force first, then the angles of joints that are free. Where thumb and index could meet on the way,
    /// it goes part by part. Arms nothing; true if something is sent.
    pub(crate) fn recall(&mut self, plan: PlayPlan, env: &Env) -> bool {
        let Some(cue) = plan.cues.first() else {
            return false;
        };
        let angle = self.sample.angle;
        let from = PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].documented()));
        if cue.legs(&from).len() > 1 {
            self.start(Some(plan), PlayMode::Through, env);
            return self.is_armed();
        }
        self.go_to(|setpoints| {
            setpoints.angle = cue.targets.map(|to| to.map(Target::Go));
            setpoints.speed = PerDof::splat(Some(cue.speed));
            setpoints.force = PerDof::splat(Some(cue.force));
        })
    }

    /// Sends the joints that are free and have a target; true if there are such. What moved the hand before does not any more.
    fn go_to(&mut self, fill: impl FnOnce(&mut Setpoints)) -> bool {
        let Some(epoch) = self.link.armed else {
            return false;
        };
        let mut wanted = Setpoints::none(epoch);
        fill(&mut wanted);
        let mut setpoints = Setpoints::none(epoch);
        for dof in Dof::ALL.into_iter().filter(|dof| self.is_free(*dof)) {
            if wanted.angle[dof].is_some() {
                setpoints.angle[dof] = wanted.angle[dof];
                setpoints.speed[dof] = wanted.speed[dof];
                setpoints.force[dof] = wanted.force[dof];
            }
        }
        if setpoints.is_empty() {
            return false;
        }
        self.take_over();
        self.show(&setpoints);
        self.send(|all| *all = setpoints);
        true
    }

    /// The sliders of free joints stand where these were sent.
    pub(crate) fn show(&mut self, sent: &Setpoints) {
        for dof in Dof::ALL {
            let Some(Target::Go(to)) = sent.angle[dof].filter(|_| self.is_free(dof)) else {
                continue;
            };
            let joint = &mut self.joints[dof];
            joint.target = Some(to);
            joint.speed = sent.speed[dof].unwrap_or(joint.speed);
            joint.force = sent.force[dof].unwrap_or(joint.force);
            self.steered[dof] = true;
        }
    }

    /// A person moves the hand: what moved it before does not any more.
    pub(crate) fn take_over(&mut self) {
        if let Some(run) = &mut self.sequence {
            run.leave();
        }
        if let Some(open) = &mut self.open {
            let _lease = open.take_lease();
        }
    }

    /// Sends for the arming in force; without one, nothing.
    pub(crate) fn send(&mut self, fill: impl FnOnce(&mut Setpoints)) {
        let (Some(open), Some(epoch)) = (&self.open, self.link.armed) else {
            return;
        };
        let mut setpoints = Setpoints::none(epoch);
        fill(&mut setpoints);
        let set = open.lease.map(|lease| open.link.set(lease, &setpoints));
        self.commanded |= matches!(set, Some(Ok(())));
    }

    /// True for joints that a person may move now.
    pub(crate) fn is_free(&self, dof: Dof) -> bool {
        let is_ours = !self.runs_series() && self.outside_owner().is_none();
        self.is_armed() && is_ours && !self.joints[dof].locked
    }
}
