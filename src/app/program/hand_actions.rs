//! User actions on the shown hand.

use crate::app::checkup::CheckupAction;
use crate::app::env::Env;
use crate::app::hand::running::AskedSeries;
use crate::app::program::hand_tick::{record_event, start_checkup};
use crate::app::program::hands;
use crate::app::state::State;
use crate::hand::kinematics::Side;
use crate::hand::{Dof, Moment};
use crate::history::{Mark, MarkKind};
use crate::record::EventKind;
use crate::store::calendar::{day, since_1970};
use crate::transport::Endpoint;

/// Replaces the shown hand by another, or by none.
pub(super) fn connect(state: &mut State, to: Option<Endpoint>, env: &Env) {
    let slot = state.hand().label.slot;
    if let Some(endpoint) = &to {
        if hands::is_open_elsewhere(state, endpoint, Some(slot)) {
            return;
        }
        // A scan may still query further ids on the requested port.
        state.scan.cancel();
        state.settings.remember(endpoint);
        state.settings.used_on(endpoint, day(since_1970()));
    }
    state.hands.set_chosen();
    hands::with_shown(state, env, |hand, settings, ctx| {
        hand.is_removed = false;
        hand.procedures.close();
        hand.leave(to, ctx);
        hand.apply_settings(settings);
    });
}

/// Starts a check-up under the current arming, or arms for it first.
pub(super) fn checkup(state: &mut State, action: CheckupAction, env: &Env) {
    hands::with_shown(state, env, |hand, settings, ctx| match action {
        CheckupAction::Start(plan) => start_checkup(hand, plan, settings, ctx),
        CheckupAction::ArmAndStart(plan) => {
            hand.arm_for_series(AskedSeries::Checkup(plan), ctx);
        }
    });
}

pub(super) fn set_hold_to_run(state: &mut State, on: bool) {
    state.settings.hold_to_run = on;
    state.hands.iter_mut().for_each(|hand| hand.need_key(on));
}

/// Adds a note to the history; empty text adds none.
pub(super) fn note(state: &mut State, at: Moment, words: &str) {
    if let Some(note) = MarkKind::note(words) {
        let hand = state.hand_mut();
        record_event(hand, at, EventKind::Note, words.trim().to_owned());
        hand.measured.history.mark(at, note);
    }
}

pub(super) fn remove_mark(state: &mut State, mark: &Mark) {
    let hand = state.hand_mut();
    if let MarkKind::Note(words) = &mark.kind {
        record_event(hand, mark.at, EventKind::NoteRemoved, words.to_string());
    }
    hand.measured.history.remove_mark(mark);
}

/// Sets the side of the shown hand.
pub(super) fn set_side(state: &mut State, side: Side) {
    let State {
        hands, settings, ..
    } = state;
    if let Some(endpoint) = &hands.shown().connection.endpoint {
        settings.set_side_of(endpoint, side);
    }
    // Hands without a side of their own use the side that was set last.
    if !hands.is_several() {
        settings.side = side;
    }
    hands.shown_mut().apply_settings(settings);
}

/// Yields one joint, or all.
pub(super) fn each(dof: Option<Dof>) -> impl Iterator<Item = Dof> {
    Dof::ALL
        .into_iter()
        .filter(move |own| dof.is_none_or(|dof| dof == *own))
}
