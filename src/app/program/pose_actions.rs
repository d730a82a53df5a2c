//! What a person does with poses and sequences.

use crate::app::action::Action;
use crate::app::env::Env;
use crate::app::hand::Play;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::hand::{Moment, PerDof};
use crate::poses::library::{EntryId, LibraryPose};
use crate::poses::preview::Preview;

impl State {
    /// Poses and sequences.
    pub(super) fn pose_action(&mut self, action: Action, env: &Env, now: Moment) {
        let Self {
            hands,
            notices,
            poses,
            settings,
            ..
        } = self;
        match action {
            Action::Capture(name) => match hands.shown().pose_now() {
                Some(angles) => {
                    poses.newest = poses.library.add_pose(&name, LibraryPose::at(angles))
                }
                None => notices.push(now, NoticeKind::PoseUnknown),
            },
            Action::Recapture(id) => match hands.shown().pose_now() {
                Some(angles) => {
                    let mut known = poses.library.poses.iter_mut();
                    if let Some(pose) = known.find(|pose| pose.id == id) {
                        pose.angles = angles;
                    }
                }
                None => notices.push(now, NoticeKind::PoseUnknown),
            },
            Action::Library(edit) => poses.edit(edit),
            Action::HideShipped(name, hide) => {
                let hidden = &mut settings.hidden_poses;
                match hide {
                    true => hidden.insert(name),
                    false => hidden.remove(&name),
                };
            }
            Action::Recall(id) => {
                let plan = poses.plan(EntryId::Pose(id));
                for hand in hands.with_shown(|hand| hand.takes_poses()) {
                    hand.now = now;
                    let plan = plan.clone();
                    if plan.is_some_and(|plan| hand.recall(plan, env)) {
                        poses.recalled = Some(id);
                    }
                }
            }
            Action::DryRun(sequence) => {
                let angle = hands.shown().sample.angle;
                let from =
                    PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].documented()));
                let preview = |id| Preview::of(poses.library_of(id), id, from, now);
                poses.preview = sequence.and_then(preview);
            }
            Action::Play(play) => {
                if matches!(play, Play::Start(_) | Play::Step(_)) {
                    poses.preview = None;
                }
                let entry = hands.shown().sequence.as_ref().map(|run| run.entry);
                for hand in hands.with_shown(|hand| hand.plays_along(play, entry)) {
                    hand.now = now;
                    hand.play(play, poses, env);
                }
            }
            action => self.setting_action(action),
        }
    }
}
