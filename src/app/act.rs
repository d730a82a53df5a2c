//! What a person asks of the hand, and the rules that stand before it. Opens no link, writes no file.

use crate::app::action::Preset;
use crate::app::desk::Desk;
use crate::app::gestures::{GestureProgress, LastGesture};
use crate::app::history::MarkKind;
use crate::app::notices::{Asked, NoticeKind};
use crate::app::state::Freshness;
use crate::app::trial::Abort;
use crate::hand::{
    Angle, Dof, Finger, Force, Gesture, GestureRoute, HandCommand, Moment, Speed, Target,
};
use crate::link::{ArmRequest, LinkState, Request, RequestError, Setpoints};

impl Desk {
    /// Holds now. Works in every state; whatever was armed is not any more, at once.
    pub(crate) fn stop(&mut self, now: Moment) {
        if let Some(link) = &self.link {
            link.stop();
        }
        self.end_trials(Abort::Person, now);
        self.state.history.mark(now, MarkKind::Stop);
        self.put_down(LinkState::Holding, now);
    }

    /// Lets no setpoint pass any more. The hand keeps what it was told.
    pub(crate) fn disarm(&mut self, now: Moment) {
        if let Some(link) = &self.link {
            link.disarm();
        }
        self.put_down(LinkState::Monitoring, now);
    }

    fn put_down(&mut self, state: LinkState, now: Moment) {
        self.disarmed_at = Some(now);
        if self.state.is_armed() {
            self.state.link.state = state;
        }
        self.state.link.armed = None;
        self.follow();
    }

    /// Asks the link to let setpoints pass, if the pose is known and nothing speaks against it.
    pub(crate) fn arm(&mut self, now: Moment) {
        if self.state.is_armed() {
            return;
        }
        if let Some(reason) = self.state.arm_refusal() {
            self.state.notices.push(now, NoticeKind::ArmRefused(reason));
            return;
        }
        let joints = self.state.joints;
        if let Some(link) = &self.link {
            link.arm(ArmRequest {
                speed: joints.map(|joint| joint.speed),
                force: joints.map(|joint| joint.force),
            });
        }
    }

    /// Where a joint should go. Nothing happens unless armed and not locked.
    pub(crate) fn target(&mut self, dof: Dof, angle: Angle) {
        if !self.is_free(dof) {
            return;
        }
        self.take_over();
        self.state.joints[dof].target = Some(angle);
        self.following[dof] = false;
        self.send(|setpoints| setpoints.angle[dof] = Some(Target::Go(angle)));
    }

    /// Force threshold of a joint: kept, and sent if armed and not locked.
    pub(crate) fn force(&mut self, dof: Dof, force: Force) {
        self.state.joints[dof].force = force;
        if self.is_free(dof) {
            self.send(|setpoints| setpoints.force[dof] = Some(force));
        }
    }

    /// Speed of a joint: kept, and sent if armed and not locked.
    pub(crate) fn speed(&mut self, dof: Dof, speed: Speed) {
        self.state.joints[dof].speed = speed;
        if self.is_free(dof) {
            self.send(|setpoints| setpoints.speed[dof] = Some(speed));
        }
    }

    /// The same force threshold for all joints.
    pub(crate) fn force_of_all(&mut self, force: Force) {
        for dof in Dof::ALL {
            self.force(dof, force);
        }
    }

    /// The same speed for all joints.
    pub(crate) fn speed_of_all(&mut self, speed: Speed) {
        for dof in Dof::ALL {
            self.speed(dof, speed);
        }
    }

    /// Leaves a joint alone, or not. Its slider stands at the actual angle until it is touched again; force and
    /// speed that were changed meanwhile go out when it is free again.
    pub(crate) fn lock(&mut self, dof: Dof, locked: bool) {
        let joint = &mut self.state.joints[dof];
        let freed = joint.locked && !locked;
        joint.locked = locked;
        let (force, speed) = (joint.force, joint.speed);
        self.following[dof] = true;
        self.follow();
        if freed && self.is_free(dof) {
            self.send(|setpoints| {
                setpoints.force[dof] = Some(force);
                setpoints.speed[dof] = Some(speed);
            });
        }
    }

    /// All joints that are not locked to where the preset has them, in one step. Those that are faster than gentle are
    /// slowed down first, on the slider too.
    pub(crate) fn preset(&mut self, preset: Preset) {
        let moves: Vec<(Dof, Angle)> = Dof::ALL
            .into_iter()
            .filter(|dof| self.is_free(*dof))
            .filter_map(|dof| Some((dof, preset.angle(dof)?)))
            .collect();
        if moves.is_empty() {
            return;
        }
        self.take_over();
        for (dof, angle) in &moves {
            let joint = &mut self.state.joints[*dof];
            joint.target = Some(*angle);
            joint.speed = joint.speed.min(Speed::GENTLE);
            self.following[*dof] = false;
        }
        let joints = self.state.joints;
        self.send(|setpoints| {
            for (dof, angle) in &moves {
                setpoints.speed[*dof] = Some(joints[*dof].speed);
                setpoints.angle[*dof] = Some(Target::Go(*angle));
            }
        });
    }

    /// Takes a stored pose. It moves every joint, so none may be locked.
    pub(crate) fn gesture(&mut self, gesture: Gesture, now: Moment) {
        let what = Asked::Gesture(gesture);
        if !self.state.is_armed() {
            self.failed(what, RequestError::NotArmed, now);
            return;
        }
        if self.state.gestures.route == GestureRoute::Off {
            self.state.notices.push(now, NoticeKind::GesturesOff);
            return;
        }
        if let Some((dof, _)) = self.state.joints.iter().find(|(_, joint)| joint.locked) {
            self.state
                .notices
                .push(now, NoticeKind::GestureWouldMoveLocked { dof });
            return;
        }
        self.take_over();
        self.state.gestures.last = Some(LastGesture {
            gesture,
            at: now,
            progress: GestureProgress::Asked,
        });
        if self.ask(
            HandCommand::Gesture(gesture, self.state.gestures.route),
            what,
            now,
        ) {
            self.state
                .history
                .mark(now, MarkKind::Gesture(gesture.get()));
            self.commanded = true;
            self.following = crate::hand::PerDof::splat(true);
        }
    }

    /// Clears what can be cleared. The link holds the pose first.
    pub(crate) fn clear_errors(&mut self, now: Moment) {
        self.ask(HandCommand::ClearErrors, Asked::ClearErrors, now);
    }

    /// Puts a person's note into the history.
    pub(crate) fn note(&mut self, at: Moment, words: &str) {
        if let Some(note) = MarkKind::note(words) {
            self.state.history.mark(at, note);
        }
    }

    /// Counts tactile channels from now, where the reading is fresh: one fingertip, or all.
    pub(crate) fn tare(&mut self, finger: Option<Finger>) {
        let fresh: Vec<Finger> = Finger::ALL
            .into_iter()
            .filter(|each| finger.is_none_or(|finger| finger == *each))
            .filter(|each| {
                let asked = self.state.sample.tactile[*each].map(|block| block.asked);
                self.state.freshness(asked) == Freshness::Live
            })
            .collect();
        self.state.tare.tare(fresh, &self.state.sample);
    }

    /// True if it is on its way.
    pub(crate) fn ask(&mut self, command: HandCommand, what: Asked, now: Moment) -> bool {
        self.request(Request::Command(command), what, now)
    }

    /// True if it is on its way.
    pub(crate) fn request(&mut self, request: Request, what: Asked, now: Moment) -> bool {
        let asked = match &self.link {
            Some(link) => link.ask(request),
            None => Err(RequestError::NotConnected),
        };
        match asked {
            Ok(ticket) => {
                self.await_end(ticket, what);
                true
            }
            Err(error) => {
                self.failed(what, error, now);
                false
            }
        }
    }

    /// Sends for the arming in force; without one, nothing.
    pub(crate) fn send(&mut self, fill: impl FnOnce(&mut Setpoints)) {
        let (Some(link), Some(epoch)) = (&self.link, self.state.link.armed) else {
            return;
        };
        let mut setpoints = Setpoints::none(epoch);
        fill(&mut setpoints);
        link.set(&setpoints);
        self.commanded = true;
    }
}
