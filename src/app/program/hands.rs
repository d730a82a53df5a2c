//! Carries out user actions on the list of hands, and stops the hands when the window closes. An action on one hand affects no
//! other.

use crate::app::controls::HoldKey;
use crate::app::env::{Ctx, Env};
use crate::app::hand::Hand;
use crate::app::hand::list::{HandList, HandsAction};
use crate::app::notices::NoticeKind;
use crate::app::settings::Settings;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::hand::Moment;
use crate::transport::Endpoint;

/// Closing of the window: hands that may move are stopped first.
#[derive(Clone, Copy)]
pub(super) struct Closing {
    pub(super) since: Moment,
    /// A hand was stopped, and its rest is awaited.
    held: bool,
}

impl Closing {
    /// Stops each hand that is armed, or that this program set in motion.
    pub(super) fn begin(state: &mut State, env: &Env, now: Moment) -> Self {
        state.now = now;
        let mut held = false;
        each_hand(state, env, |hand, ctx| {
            if hand.connection.may_move() {
                hand.stop(ctx);
                held = true;
            }
        });
        Self { since: now, held }
    }

    /// True once each stopped hand rests or has disconnected.
    pub(super) fn is_at_rest(&self, hands: &HandList) -> bool {
        !self.held || hands.iter().all(|hand| hand.connection.is_held(self.since))
    }
}

/// Carries out a user action.
pub(super) fn act(state: &mut State, action: HandsAction, env: &Env) {
    match action {
        HandsAction::Add => {
            state.hands.add(state.now);
            hand_is_shown(state);
        }
        HandsAction::Show(slot) => {
            state.hands.show(slot);
            hand_is_shown(state);
        }
        HandsAction::Remove(slot) => {
            state.hands.set_chosen();
            remove_hand(state, slot, env);
        }
        HandsAction::Name(slot, name) => {
            let hand = state.hands.iter().find(|hand| hand.label.slot == slot);
            if let Some(endpoint) = hand.and_then(|hand| hand.connection.endpoint.as_ref()) {
                state.settings.name_hand(endpoint, &name);
            }
        }
        HandsAction::StopOne(slot) => with_hand(state, slot, env, |hand, _, ctx| hand.stop(ctx)),
        HandsAction::PosesForAll(on) => state.hands.set_poses_for_all(on),
    }
}

/// Remembers the open hands for the next start, once the user chose some of them.
pub(super) fn remember_open(state: &mut State) {
    if !state.hands.are_chosen() {
        return;
    }
    let open = state.hands.iter().filter(|hand| !hand.is_removed);
    let open = open.filter_map(|hand| hand.connection.endpoint.as_ref());
    let open: Vec<String> = open.map(ToString::to_string).collect();
    state.settings.open = if open.len() > 1 { open } else { Vec::new() };
}

/// Shows the hand of this endpoint, if it is open.
pub(super) fn show_last(state: &mut State, endpoint: Option<&str>) {
    let is_last = |hand: &&Hand| {
        let own = hand.connection.endpoint.as_ref().map(ToString::to_string);
        own.is_some() && own.as_deref() == endpoint
    };
    let last = state.hands.iter().find(is_last);
    if let Some(slot) = last.map(|hand| hand.label.slot) {
        state.hands.show(slot);
    }
}

/// Ends a dry run, which started at the pose of the hand shown before.
fn hand_is_shown(state: &mut State) {
    state.poses.preview = None;
    state.hands.shown_mut().apply_settings(&state.settings);
}

fn remove_hand(state: &mut State, slot: SlotId, env: &Env) {
    if !state.hands.is_several() {
        return;
    }
    with_hand(state, slot, env, |hand, _, ctx| {
        hand.procedures.close();
        hand.leave(None, ctx);
        hand.is_removed = true;
    });
    forget_removed(state);
    drop_removed(state);
}

/// Makes a remaining hand the first of the next start.
fn forget_removed(state: &mut State) {
    let mut left = state.hands.iter().filter(|hand| !hand.is_removed);
    if let Some(endpoint) = left.find_map(|hand| hand.connection.endpoint.as_ref()) {
        state.settings.endpoint = Some(endpoint.to_string());
    }
}

/// Removes the slots of hands that were to be removed and are now disconnected.
pub(super) fn drop_removed(state: &mut State) {
    let is_gone = |hand: &&Hand| hand.is_removed && hand.connection.open.is_none();
    let gone: Vec<SlotId> = state
        .hands
        .iter()
        .filter(is_gone)
        .map(|hand| hand.label.slot)
        .collect();
    for slot in gone {
        let was_shown = state.hands.shown().label.slot == slot;
        state.hands.remove(slot);
        if was_shown {
            hand_is_shown(state);
        }
    }
    for hand in state
        .hands
        .iter_mut()
        .filter(|hand| hand.connection.open.is_none())
    {
        // The last slot remains.
        hand.is_removed = false;
    }
}

/// Stops (holds) every hand. A slot without a hand has nothing to stop, unless there is no hand at all.
pub(super) fn stop_all(state: &mut State, env: &Env) {
    let any = state.hands.iter().any(has_hand);
    let shown = state.hands.shown().label.slot;
    each_hand(state, env, |hand, ctx| {
        if has_hand(hand) || !any && hand.label.slot == shown {
            hand.stop(ctx);
        }
    });
}

/// Applies the hold-to-run key: holding it permits motion of every armed hand; pressing it arms only the shown one.
pub(super) fn hold_key(state: &mut State, key: HoldKey, env: &Env) {
    let shown = state.hands.shown().label.slot;
    each_hand(state, env, |hand, ctx| {
        let key = match key {
            HoldKey::Pressed if hand.label.slot != shown => HoldKey::Held,
            key => key,
        };
        hand.hold_key(key, ctx);
    });
}

/// Applies a function to the shown hand.
pub(super) fn with_shown<T>(
    state: &mut State,
    env: &Env,
    act: impl FnOnce(&mut Hand, &mut Settings, &mut Ctx<'_>) -> T,
) -> T {
    let State {
        hands,
        notices,
        settings,
        now,
        ..
    } = state;
    let is_several = hands.is_several();
    let hand = hands.shown_mut();
    let mut ctx = Ctx {
        now: *now,
        env,
        notices: notices.about(is_several.then_some(&hand.label)),
    };
    act(hand, settings, &mut ctx)
}

/// Applies a function to the hand of a slot, if there is one.
pub(super) fn with_hand(
    state: &mut State,
    slot: SlotId,
    env: &Env,
    act: impl Fn(&mut Hand, &mut Settings, &mut Ctx<'_>),
) {
    let State {
        hands,
        notices,
        settings,
        now,
        ..
    } = state;
    let is_several = hands.is_several();
    if let Some(hand) = hands.get_mut(slot) {
        let mut ctx = Ctx {
            now: *now,
            env,
            notices: notices.about(is_several.then_some(&hand.label)),
        };
        act(hand, settings, &mut ctx);
    }
}

/// Applies a function to each hand.
fn each_hand(state: &mut State, env: &Env, mut act: impl FnMut(&mut Hand, &mut Ctx<'_>)) {
    let State {
        hands,
        notices,
        now,
        ..
    } = state;
    let is_several = hands.is_several();
    for hand in hands.iter_mut() {
        let mut ctx = Ctx {
            now: *now,
            env,
            notices: notices.about(is_several.then_some(&hand.label)),
        };
        act(hand, &mut ctx);
    }
}

/// True if a slot other than `own` has this hand or the port that leads to it; the user is notified.
pub(super) fn is_open_elsewhere(
    state: &mut State,
    endpoint: &Endpoint,
    own: Option<SlotId>,
) -> bool {
    let hands = state.hands.iter();
    let mut others = hands.filter(|hand| Some(hand.label.slot) != own);
    let Some(other) = others.find(|hand| leads_to(hand, endpoint)) else {
        return false;
    };
    let told = NoticeKind::OpenElsewhere {
        endpoint: endpoint.to_string(),
        hand: other.label.name.to_string(),
    };
    state.notices.push(state.now, told);
    true
}

fn has_hand(hand: &Hand) -> bool {
    hand.connection.endpoint.is_some()
}

/// True if this endpoint leads to this hand, or uses its port: a serial port has room for one.
fn leads_to(hand: &Hand, endpoint: &Endpoint) -> bool {
    let connection = &hand.connection;
    let going = hand.leaving.as_ref();
    let going = going.and_then(|leaving| leaving.to.as_ref());
    let mut own = connection.endpoint.iter().chain(going);
    own.any(|own| {
        let moved = connection.status.moved_to.as_deref();
        let is_port = endpoint.port().is_some_and(|port| {
            own.port() == Some(port) || own.port().is_some() && moved == Some(port)
        });
        let is_same = !own.is_sim() && own.place_and_id() == endpoint.place_and_id();
        own == endpoint || is_port || is_same
    })
}
