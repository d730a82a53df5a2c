//! Taring of the fingertips by the user, stored for the next connection with the same hand, and offered then.

use crate::app::env::{Ctx, Env};
use crate::app::hand::Hand;
use crate::app::notices::NoticeKind;
use crate::app::program::hands;
use crate::app::readings::Freshness;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::hand::{Finger, Moment};
use crate::store::calendar::since_1970;
use crate::transport::Endpoint;

/// Tares one fingertip of the shown hand, or all, and stores it.
pub(super) fn tare(state: &mut State, finger: Option<Finger>, env: &Env) {
    hands::with_shown(state, env, |hand, settings, ctx| {
        tare_fresh(hand, finger, ctx);
        keep(hand, settings, ctx.now);
    });
}

/// Undoes the last taring of the shown hand, also in the settings.
pub(super) fn undo(state: &mut State, env: &Env) {
    hands::with_shown(state, env, |hand, settings, ctx| {
        hand.readings.tare.undo();
        keep(hand, settings, ctx.now);
    });
}

/// Applies the stored taring to fresh readings of the shown hand. Refused if a fingertip is touched.
pub(super) fn restore(state: &mut State, env: &Env) {
    hands::with_shown(state, env, |hand, _, ctx| {
        let fresh = fresh_tips(hand, ctx.now);
        let readings = &mut hand.readings;
        let taken = readings.tare.apply_stored(fresh, &readings.sample, ctx.now);
        if let Err((finger, newtons)) = taken {
            ctx.notify(NoticeKind::TareUnderLoad { finger, newtons });
        }
    });
}

/// Offers the stored taring of the same hand, once per connection. Applies nothing.
pub(super) fn offer(hand: &mut Hand, settings: &Settings, now: Moment) {
    if hand.connection.is_live() && !hand.readings.tare.was_offered() {
        let kept = tared_hand(hand).and_then(|hand| settings.tares.get(&hand));
        hand.readings.tare.offer(kept.cloned(), since_1970(), now);
    }
}

/// Tares the fresh readings of one fingertip, or of all. Refused if one of them is touched.
fn tare_fresh(hand: &mut Hand, finger: Option<Finger>, ctx: &mut Ctx<'_>) {
    let mut fresh = fresh_tips(hand, ctx.now);
    fresh.retain(|each| finger.is_none_or(|finger| finger == *each));
    let readings = &mut hand.readings;
    if let Err((finger, newtons)) = readings.tare.tare(fresh, &readings.sample) {
        ctx.notify(NoticeKind::TareUnderLoad { finger, newtons });
    }
}

fn fresh_tips(hand: &Hand, now: Moment) -> Vec<Finger> {
    let is_live = hand.connection.is_live();
    let freshness = |finger| hand.readings.tip_freshness(finger, is_live, now);
    let is_fresh = |finger: &Finger| freshness(*finger) == Freshness::Live;
    Finger::ALL.into_iter().filter(is_fresh).collect()
}

/// Stores the user's taring in the settings.
fn keep(hand: &Hand, settings: &mut Settings, now: Moment) {
    if let Some(tared) = tared_hand(hand) {
        settings.keep_tare(tared, hand.readings.tare.to_keep(since_1970(), now));
    }
}

/// Key of the hand for stored tarings: its place and id; `None` for the built-in hand.
fn tared_hand(hand: &Hand) -> Option<String> {
    let endpoint = hand.connection.endpoint.as_ref();
    let (place, id) = endpoint
        .filter(|it| !it.is_sim())
        .map(Endpoint::place_and_id)?;
    Some(format!("{place} id {id}"))
}
