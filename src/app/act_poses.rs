//! What a person asks of the hand with poses, sequences and the hand's own memory of gestures. The rules of motion hold
//! as for sliders: armed, not locked, speed and force first.

use crate::app::action::Play;
use crate::app::desk::Desk;
use crate::app::gestures::{Stored, Upload, Verdict};
use crate::app::notices::{Asked, NoticeKind};
use crate::app::poses::book::Run;
use crate::app::poses::library::{Pose, PoseId, SequenceId};
use crate::app::poses::player::{End, Pace, Player, cues};
use crate::app::poses::preview::Preview;
use crate::app::state::Freshness;
use crate::hand::command::stored_gesture;
use crate::hand::{
    Angle, Dof, Force, GestureStore, HandCommand, Moment, PerDof, Speed, Target, UserGesture,
};
use crate::link::{LinkState, Outcome, Request};

/// Where joints go and within which limits; what is `None` stays as it is.
#[derive(Debug, Clone, Copy)]
struct Way {
    to: PerDof<Option<Angle>>,
    speed: PerDof<Option<Speed>>,
    force: PerDof<Option<Force>>,
}

impl Desk {
    /// Keeps the pose that the hand has now, if all six angles are known and fresh.
    pub(crate) fn capture(&mut self, name: &str, now: Moment) {
        let Some(angles) = self.state.pose_now() else {
            self.state.notices.push(now, NoticeKind::PoseUnknown);
            return;
        };
        let poses = &mut self.state.poses;
        poses.newest = poses.library.add_pose(name, Pose::at(angles));
    }

    /// Puts the pose that the hand has now in the place of one that is kept.
    pub(crate) fn recapture(&mut self, id: PoseId, now: Moment) {
        let Some(angles) = self.state.pose_now() else {
            self.state.notices.push(now, NoticeKind::PoseUnknown);
            return;
        };
        let mut poses = self.state.poses.library.poses.iter_mut();
        if let Some(pose) = poses.find(|pose| pose.id == id) {
            pose.angles = angles;
        }
    }

    /// Takes a pose of the library: speed and force first, then the angles of joints that are free. Arms nothing.
    pub(crate) fn recall(&mut self, id: PoseId) {
        let Some(pose) = self.state.poses.library.pose(id) else {
            return;
        };
        let way = Way {
            to: pose.targets(),
            speed: PerDof::splat(Some(pose.speed)),
            force: PerDof::splat(Some(pose.force)),
        };
        self.take_over();
        if self.go(&way) {
            self.state.poses.recalled = Some(id);
        }
    }

    /// Goes to six angles that are being edited, at a gentle speed at most.
    pub(crate) fn try_angles(&mut self, angles: PerDof<Angle>) {
        let joints = self.state.joints;
        self.take_over();
        self.go(&Way {
            to: angles.map(Some),
            speed: PerDof::from_fn(|dof| Some(joints[dof].speed.min(Speed::GENTLE))),
            force: PerDof::splat(None),
        });
    }

    /// True if something was sent.
    fn go(&mut self, way: &Way) -> bool {
        let free = PerDof::from_fn(|dof| way.to[dof].filter(|_| self.is_free(dof)));
        if free.iter().all(|(_, to)| to.is_none()) {
            return false;
        }
        for (dof, to) in free.iter().filter(|(_, to)| to.is_some()) {
            let joint = &mut self.state.joints[dof];
            joint.target = *to;
            joint.speed = way.speed[dof].unwrap_or(joint.speed);
            joint.force = way.force[dof].unwrap_or(joint.force);
            self.following[dof] = false;
        }
        self.send(|setpoints| {
            for (dof, to) in free.iter() {
                let Some(to) = *to else { continue };
                setpoints.speed[dof] = way.speed[dof];
                setpoints.force[dof] = way.force[dof];
                setpoints.angle[dof] = Some(Target::Go(to));
            }
        });
        true
    }

    /// Starts, pauses or ends a sequence.
    pub(crate) fn play(&mut self, play: Play, now: Moment) {
        match play {
            Play::Start(id) => self.start(id, Pace::Through, now),
            Play::Step(id) => self.step(id, now),
            Play::Pause => {
                if self.player().is_some_and(Player::pause) {
                    self.hold_here();
                }
            }
            Play::Resume => {
                if let Some(player) = self.player() {
                    player.resume(Pace::Through, now);
                }
            }
            Play::End => self.end_here(),
            Play::Dry(id) => self.dry_run(id, now),
            Play::EndDry => self.state.poses.preview = None,
        }
    }

    fn player(&mut self) -> Option<&mut Player> {
        self.state.poses.run.as_mut().map(|run| &mut run.player)
    }

    fn start(&mut self, id: SequenceId, pace: Pace, now: Moment) {
        let Some(epoch) = self.state.link.armed.filter(|_| self.state.is_armed()) else {
            return;
        };
        let poses = &mut self.state.poses;
        let looped = poses.library.sequence(id).is_some_and(|own| own.looped);
        let player = Player::start(cues(&poses.library, id), looped, pace, now);
        poses.preview = None;
        poses.run = Some(Run {
            sequence: id,
            player,
            epoch,
        });
        self.tick_sequence(now);
    }

    /// One step on: of the sequence that waits, or the first of one that does not run.
    fn step(&mut self, id: SequenceId, now: Moment) {
        let waits = |run: &Run| run.sequence == id && run.player.is_paused();
        if self.state.poses.run.as_ref().is_some_and(waits) {
            if let Some(player) = self.player() {
                player.resume(Pace::OneStep, now);
            }
        } else {
            self.start(id, Pace::OneStep, now);
        }
    }

    fn dry_run(&mut self, id: SequenceId, now: Moment) {
        let angle = self.state.sample.angle;
        let from = PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].documented()));
        let poses = &mut self.state.poses;
        let looped = poses.library.sequence(id).is_some_and(|own| own.looped);
        let cues = cues(&poses.library, id);
        poses.preview = (!cues.is_empty()).then(|| Preview::start(id, cues, looped, from, now));
    }

    fn end_here(&mut self) {
        if self.state.poses.is_running() {
            if let Some(player) = self.player() {
                player.end(End::Person);
            }
            self.hold_here();
        }
    }

    /// The targets of the free joints become where they are. Nothing is sent that is not fresh.
    fn hold_here(&mut self) {
        if let Some(angles) = self.state.pose_now() {
            self.go(&Way {
                to: angles.map(Some),
                speed: PerDof::splat(None),
                force: PerDof::splat(None),
            });
        }
    }

    /// A person moves the hand in another way: the sequence does not fight for it.
    pub(crate) fn take_over(&mut self) {
        if let Some(player) = self.player() {
            player.end(End::TakenOver);
        }
    }

    /// Lets the running sequence go on, or ends it. Called each time that news were taken in.
    pub(crate) fn tick_sequence(&mut self, now: Moment) {
        if !self.state.poses.is_running() {
            return;
        }
        if let Some(why) = self.sequence_end() {
            if let Some(player) = self.player() {
                player.end(why);
            }
            return;
        }
        let angle = self.state.sample.angle;
        let fresh = self.state.freshness(angle.map(|angle| angle.asked)) == Freshness::Live;
        let Some(angle) = angle.filter(|_| fresh) else {
            return;
        };
        let joints = self.state.joints;
        let Some(player) = self.player() else { return };
        // A locked joint never arrives and is not waited for: it counts as where it should be.
        let targets = player.targets();
        let seen = PerDof::from_fn(|dof| {
            let target = targets[dof].filter(|_| joints[dof].locked).map(Angle::get);
            Some(target.unwrap_or_else(|| angle.value[dof].raw()))
        });
        if let Some(cue) = player.tick(now, &seen) {
            self.go(&Way {
                to: cue.targets,
                speed: PerDof::splat(Some(cue.speed)),
                force: PerDof::splat(Some(cue.force)),
            });
        }
    }

    fn sequence_end(&self) -> Option<End> {
        let link = &self.state.link;
        let epoch = self.state.poses.run.as_ref().map(|run| run.epoch);
        if !link.state.is_live() {
            Some(End::LinkLost)
        } else if link.state == LinkState::Fault || self.state.faults.active().next().is_some() {
            Some(End::Fault)
        } else if !self.state.is_armed() || link.armed != epoch {
            Some(End::Disarmed)
        } else {
            None
        }
    }

    /// Stores six angles under a number of the user's, then reads them back.
    pub(crate) fn store_gesture(&mut self, to: UserGesture, angles: PerDof<Angle>, now: Moment) {
        if self.store_is_off(now) {
            return;
        }
        self.state.gestures.upload = Some(Upload {
            gesture: to,
            wanted: angles,
            verdict: Verdict::Writing,
        });
        let command = HandCommand::StoreGesture(to, angles);
        self.ask(command, Asked::StoreGesture(to), now);
    }

    /// Reads what is stored under a number of the user's.
    pub(crate) fn read_gesture(&mut self, gesture: UserGesture, now: Moment) {
        if self.store_is_off(now) {
            return;
        }
        let span = stored_gesture(gesture);
        self.request(Request::Read(span), Asked::ReadGesture(gesture), now);
    }

    /// Says so if the person wants no address touched that the manual does not list.
    fn store_is_off(&mut self, now: Moment) -> bool {
        let off = self.state.settings.gesture_store == GestureStore::Off;
        if off {
            self.state.notices.push(now, NoticeKind::GestureStoreOff);
        }
        off
    }

    /// A gesture was written or read: the next thing to do, or the verdict.
    pub(crate) fn gesture_answered(&mut self, what: Asked, outcome: &Outcome, now: Moment) {
        match (what, outcome) {
            (Asked::StoreGesture(gesture), Outcome::Acknowledged) => {
                self.state.gestures.judge(gesture, Verdict::ReadingBack);
                self.read_gesture(gesture, now);
            }
            (Asked::ReadGesture(gesture), Outcome::Memory { bytes, .. }) => {
                let (pairs, _) = bytes.as_chunks::<2>();
                let mut pairs = pairs.iter().map(|pair| i16::from_le_bytes(*pair));
                let got = PerDof::from_fn(|_| pairs.next()).all();
                if let Some(got) = got {
                    self.state.gestures.read_back(Stored {
                        gesture,
                        angles: got,
                    });
                }
            }
            _ => {}
        }
    }

    /// True for joints that a recall of this pose would move.
    pub(crate) fn is_free(&self, dof: Dof) -> bool {
        self.state.is_armed() && !self.state.tuner.is_running() && !self.state.joints[dof].locked
    }
}
