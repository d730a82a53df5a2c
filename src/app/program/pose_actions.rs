//! User actions on poses and sequences.

use crate::app::activity::RecordedPlay;
use crate::app::env::Env;
use crate::app::hand::Hand;
use crate::app::hand::running::SequenceRun;
use crate::app::notices::NoticeKind;
use crate::app::poses::PoseState;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::hand::{Angle, Moment, PerDof, Target};
use crate::motion::play::PlayCommand;
use crate::poses::library::{EntryId, LibraryPose, PoseId, SequenceId};
use crate::poses::player::PlayMode;
use crate::poses::preview::Preview;
use crate::poses::{Play, Preset};

/// Stores the pose of the shown hand under this name or the next free one.
pub(super) fn capture(state: &mut State, name: &str) {
    if let Some(angles) = pose_now(state) {
        let poses = &mut state.poses;
        poses.newest = poses.library.add_pose(name, LibraryPose::at(angles));
    }
}

/// Replaces this pose by the pose of the shown hand.
pub(super) fn recapture(state: &mut State, id: PoseId) {
    if let Some(angles) = pose_now(state) {
        let mut known = state.poses.library.poses.iter_mut();
        if let Some(pose) = known.find(|pose| pose.id == id) {
            pose.set_gap(None);
            pose.angles = angles;
        }
    }
}

/// Pose of the shown hand; `None`, with a notice, if it is not known.
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

/// Moves each hand that accepts poses to a pose.
pub(super) fn recall(state: &mut State, id: PoseId, env: &Env) {
    let entry = EntryId::Pose(id);
    for hand in state.hands.with_shown(accepts_poses) {
        let library = (&state.poses, &state.settings);
        if start(hand, library, (entry, PlayMode::Through), (env, state.now)) {
            state.poses.recalled = Some(id);
        }
    }
}

/// Starts an entry of the library, and records its name. True if it was started.
fn start(
    hand: &mut Hand,
    (poses, settings): (&PoseState, &Settings),
    (entry, pace): (EntryId, PlayMode),
    (env, now): (&Env, Moment),
) -> bool {
    let plan = poses.plan(entry);
    let blocks = settings.size_blocks(hand.connection.endpoint.as_ref());
    let is_started = plan.is_some_and(|plan| hand.play(plan, pace, blocks, (env, now)));
    if let Some(names) = poses.named(entry).filter(|_| is_started) {
        hand.record_play(&RecordedPlay::of(entry, names.text), now);
    }
    is_started
}

/// Shows a sequence on the drawn hand, starting at the current pose; `None` ends that.
pub(super) fn dry_run(state: &mut State, sequence: Option<SequenceId>) {
    let angle = state.hands.shown().readings.sample.angle;
    let from = PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].documented()));
    let (poses, now) = (&mut state.poses, state.now);
    let preview = |id| Preview::of(poses.library_of(id), id, from, now);
    poses.preview = sequence.and_then(preview);
}

/// Plays with each participating hand.
pub(super) fn play(state: &mut State, play: Play, env: &Env) {
    if matches!(play, Play::Start(_) | Play::Step(_)) {
        state.poses.preview = None;
    }
    let entry = state.hands.shown().running.sequence().map(|run| run.entry);
    for hand in state
        .hands
        .with_shown(|hand| plays_along(hand, play, entry))
    {
        if let Some(command) = command(hand, play) {
            if let Some(run) = hand.running.sequence() {
                run.command(command);
            }
        } else if let Some(begun) = begun(play) {
            let library = (&state.poses, &state.settings);
            start(hand, library, begun, (env, state.now));
        }
    }
}

/// Moves all unlocked joints to their preset targets, in one step, at the set speeds.
pub(super) fn preset(hand: &mut Hand, preset: Preset) {
    hand.go_to(|setpoints| {
        setpoints.angle = PerDof::from_fn(|dof| preset.angle(dof).map(Target::Go));
    });
}

/// What an action says to the sequence that runs on a hand; `None` if it begins an entry there.
fn command(hand: &Hand, play: Play) -> Option<PlayCommand> {
    match play {
        Play::Start(_) => None,
        Play::Step(id) => {
            let waits = |run: &SequenceRun| run.entry == EntryId::Sequence(id) && run.is_paused();
            let waits = hand.running.sequence().is_some_and(waits);
            waits.then_some(PlayCommand::Resume(PlayMode::OneStep))
        }
        Play::Pause => Some(PlayCommand::Pause),
        Play::Resume => Some(PlayCommand::Resume(PlayMode::Through)),
        Play::End => Some(PlayCommand::End),
    }
}

/// Entry that an action begins, and how far it plays.
const fn begun(play: Play) -> Option<(EntryId, PlayMode)> {
    match play {
        Play::Start(entry) => Some((entry, PlayMode::Through)),
        Play::Step(id) => Some((EntryId::Sequence(id), PlayMode::OneStep)),
        Play::Pause | Play::Resume | Play::End => None,
    }
}

/// True if a hand accepts a pose meant for all: it is armed, and the user at this window has control.
pub(super) fn accepts_poses(hand: &Hand) -> bool {
    hand.own_epoch().is_some()
}

/// True if this hand takes part in an action on the shown one that is meant for all. `entry` is the entry that the shown hand plays:
/// no other entry is resumed with it.
fn plays_along(hand: &Hand, play: Play, entry: Option<EntryId>) -> bool {
    match play {
        Play::Start(_) | Play::Step(_) => accepts_poses(hand),
        Play::Resume => hand.running.sequence().map(|run| run.entry) == entry,
        Play::Pause | Play::End => true,
    }
}
