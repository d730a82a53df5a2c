//! What the user does with poses and sequences.

use crate::app::env::Env;
use crate::app::hand::SequenceRun;
use crate::app::hands::Hand;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::hand::{Angle, PerDof, Target};
use crate::motion::play::PlayCommand;
use crate::poses::library::{EntryId, LibraryPose, PoseId, SequenceId};
use crate::poses::player::PlayMode;
use crate::poses::preview::Preview;
use crate::poses::{Play, Preset};

/// Keeps the pose of the hand that is shown, by this name or the next free one.
pub(super) fn capture(state: &mut State, name: &str) {
    if let Some(angles) = pose_now(state) {
        let poses = &mut state.poses;
        poses.newest = poses.library.add_pose(name, LibraryPose::at(angles));
    }
}

/// Puts the pose of the hand that is shown in the place of this one.
pub(super) fn recapture(state: &mut State, id: PoseId) {
    if let Some(angles) = pose_now(state) {
        let mut known = state.poses.library.poses.iter_mut();
        if let Some(pose) = known.find(|pose| pose.id == id) {
            pose.set_gap(None);
            pose.angles = angles;
        }
    }
}

/// The pose of the hand that is shown; if it is not known, that is told.
fn pose_now(state: &mut State) -> Option<PerDof<Angle>> {
    let known = state.hands.shown().pose_now(state.now);
    if known.is_none() {
        state.notices.push(state.now, NoticeKind::PoseUnknown);
    }
    known
}

pub(super) fn hide_shipped(state: &mut State, name: String, hide: bool) {
    let hidden = &mut state.settings.hidden_poses;
    if hide {
        hidden.insert(name)
    } else {
        hidden.remove(&name)
    };
}

/// Takes a pose, with each hand that takes poses.
pub(super) fn recall(state: &mut State, id: PoseId, env: &Env) {
    let plan = state.poses.plan(EntryId::Pose(id));
    for hand in state.hands.with_shown(takes_poses) {
        let plan = plan.clone();
        if plan.is_some_and(|plan| hand.play(plan, PlayMode::Through, env, state.now)) {
            state.poses.recalled = Some(id);
        }
    }
}

/// Shows a sequence on the drawn hand, from where the hand is now, or none any more.
pub(super) fn dry_run(state: &mut State, sequence: Option<SequenceId>) {
    let angle = state.hands.shown().readings.sample.angle;
    let from = PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].documented()));
    let (poses, now) = (&mut state.poses, state.now);
    let preview = |id| Preview::of(poses.library_of(id), id, from, now);
    poses.preview = sequence.and_then(preview);
}

/// Plays, with each hand that plays along.
pub(super) fn play(state: &mut State, play: Play, env: &Env) {
    if matches!(play, Play::Start(_) | Play::Step(_)) {
        state.poses.preview = None;
    }
    let entry = state.hands.shown().running.sequence().map(|run| run.entry);
    for hand in state
        .hands
        .with_shown(|hand| plays_along(hand, play, entry))
    {
        match next_step(hand, play) {
            PlayStep::Tell(command) => {
                if let Some(run) = hand.running.sequence() {
                    run.command(command);
                }
            }
            PlayStep::Start(entry, pace) => {
                if let Some(plan) = state.poses.plan(entry) {
                    hand.play(plan, pace, env, state.now);
                }
            }
        }
    }
}

/// All joints that are not locked to where the preset has them, in one step, at the speeds that are set.
pub(super) fn preset(hand: &mut Hand, preset: Preset) {
    hand.go_to(|setpoints| {
        setpoints.angle = PerDof::from_fn(|dof| preset.angle(dof).map(Target::Go));
    });
}

/// What a wish to play comes to at one hand.
enum PlayStep {
    Start(EntryId, PlayMode),
    Tell(PlayCommand),
}

fn next_step(hand: &Hand, play: Play) -> PlayStep {
    match play {
        Play::Start(entry) => PlayStep::Start(entry, PlayMode::Through),
        Play::Step(id) => {
            let entry = EntryId::Sequence(id);
            let waits = |run: &SequenceRun| run.entry == entry && run.is_paused();
            if hand.running.sequence().is_some_and(waits) {
                PlayStep::Tell(PlayCommand::Resume(PlayMode::OneStep))
            } else {
                PlayStep::Start(entry, PlayMode::OneStep)
            }
        }
        Play::Pause => PlayStep::Tell(PlayCommand::Pause),
        Play::Resume => PlayStep::Tell(PlayCommand::Resume(PlayMode::Through)),
        Play::End => PlayStep::Tell(PlayCommand::End),
    }
}

/// True for a hand that takes a pose which is meant for all: it is armed, and the user at this window moves it.
pub(super) fn takes_poses(hand: &Hand) -> bool {
    hand.own_epoch().is_some()
}

/// True if this hand does what the user asks of the shown one, where that is meant for all. `entry` is what the shown one plays:
/// nothing else is resumed with it.
fn plays_along(hand: &Hand, play: Play, entry: Option<EntryId>) -> bool {
    match play {
        Play::Start(_) | Play::Step(_) => takes_poses(hand),
        Play::Resume => hand.running.sequence().map(|run| run.entry) == entry,
        Play::Pause | Play::End => true,
    }
}
