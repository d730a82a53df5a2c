//! What a person does with poses and sequences.

use crate::app::env::Env;
use crate::app::hand::Play;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::hand::{Angle, PerDof};
use crate::poses::library::{EntryId, LibraryPose, PoseId, SequenceId};
use crate::poses::preview::Preview;

impl State {
    /// Keeps the pose of the hand that is shown, by this name or the next free one.
    pub(super) fn capture(&mut self, name: &str) {
        if let Some(angles) = self.pose_now() {
            let poses = &mut self.poses;
            poses.newest = poses.library.add_pose(name, LibraryPose::at(angles));
        }
    }

    /// Puts the pose of the hand that is shown in the place of this one.
    pub(super) fn recapture(&mut self, id: PoseId) {
        if let Some(angles) = self.pose_now() {
            let mut known = self.poses.library.poses.iter_mut();
            if let Some(pose) = known.find(|pose| pose.id == id) {
                pose.angles = angles;
            }
        }
    }

    /// The pose of the hand that is shown; if it is not known, that is told.
    fn pose_now(&mut self) -> Option<PerDof<Angle>> {
        let known = self.hands.shown().pose_now();
        if known.is_none() {
            self.notices.push(self.now, NoticeKind::PoseUnknown);
        }
        known
    }

    pub(super) fn hide_shipped(&mut self, name: String, hide: bool) {
        let hidden = &mut self.settings.hidden_poses;
        if hide {
            hidden.insert(name)
        } else {
            hidden.remove(&name)
        };
    }

    /// Takes a pose, with each hand that takes poses.
    pub(super) fn recall(&mut self, id: PoseId, env: &Env) {
        let plan = self.poses.plan(EntryId::Pose(id));
        for hand in self.hands.with_shown(|hand| hand.takes_poses()) {
            hand.now = self.now;
            let plan = plan.clone();
            if plan.is_some_and(|plan| hand.recall(plan, env)) {
                self.poses.recalled = Some(id);
            }
        }
    }

    /// Shows a sequence on the drawn hand, from where the hand is now, or none any more.
    pub(super) fn dry_run(&mut self, sequence: Option<SequenceId>) {
        let angle = self.hands.shown().sample.angle;
        let from = PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].documented()));
        let (poses, now) = (&mut self.poses, self.now);
        let preview = |id| Preview::of(poses.library_of(id), id, from, now);
        poses.preview = sequence.and_then(preview);
    }

    /// Plays, with each hand that plays along.
    pub(super) fn play(&mut self, play: Play, env: &Env) {
        if matches!(play, Play::Start(_) | Play::Step(_)) {
            self.poses.preview = None;
        }
        let entry = self.hands.shown().sequence.as_ref().map(|run| run.entry);
        for hand in self.hands.with_shown(|hand| hand.plays_along(play, entry)) {
            hand.now = self.now;
            hand.play(play, &self.poses, env);
        }
    }
}
