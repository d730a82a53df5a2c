//! Grips by size with the shown hand, and the blocks that calibrate its sizes.

use crate::app::activity::RecordedPlay;
use crate::app::env::Env;
use crate::app::hand::grip;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::hand::gap::{Block, Gap, SizeBlocks};
use crate::poses::library::EntryId;
use crate::poses::player::{Cue, PlayMode, PlayPlan};
use crate::poses::starter::starter;
use std::time::Duration;

/// The shipped pose with which the hand opens for a pinch.
const PINCH: &str = "Pinch";
/// Time limit for each leg of the opening, at the slowest useful speed.
const OPEN_TIMEOUT: Duration = Duration::from_secs(30);

/// Moves to a gap. If thumb and index could collide on the path, the hand only opens: the user starts the next step.
pub(super) fn pinch(state: &mut State, gap: Gap, env: &Env) {
    let now = state.now;
    let hand = state.hand_mut();
    if grip::locks_pinch(hand) {
        return;
    }
    if grip::is_open_for_pinch(hand) {
        grip::pinch_to(hand, gap);
        return;
    }
    let Some(pose) = starter().pose_named(PINCH) else {
        return;
    };
    let opened = Cue {
        targets: Gap::MAX.angles().map(Some),
        limit: OPEN_TIMEOUT,
        ..Cue::of(pose)
    };
    let plan = PlayPlan {
        entry: EntryId::Pose(pose.id),
        cues: vec![opened],
        looped: false,
        reaction: None,
    };
    let played = RecordedPlay::of(plan.entry, PINCH);
    if hand.play(plan, PlayMode::Through, SizeBlocks::default(), (env, now)) {
        hand.record_play(&played, now);
    }
}

/// Stores the object held now as a block of this size.
pub(super) fn measure_block(state: &mut State, size_mm: f32) {
    let State {
        hands,
        settings,
        notices,
        now,
        ..
    } = state;
    let hand = hands.shown();
    let (Some(gap), Some(endpoint)) = (grip::held_gap(hand, *now), &hand.connection.endpoint)
    else {
        return;
    };
    let gap_mm = gap.mm;
    let mut blocks = settings.size_blocks(Some(endpoint));
    match blocks.measure(Block { size_mm, gap_mm }) {
        Ok(()) => settings.keep_size_blocks(endpoint, blocks),
        Err(error) => notices.push(*now, NoticeKind::BlockNotTaken(error)),
    }
}

/// Discards the blocks of the shown hand, so that its sizes follow the model again.
pub(super) fn forget_blocks(state: &mut State) {
    let endpoint = state.hand().connection.endpoint.clone();
    if let Some(endpoint) = endpoint {
        state
            .settings
            .keep_size_blocks(&endpoint, SizeBlocks::default());
    }
}
