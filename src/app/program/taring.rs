//! Taring of the fingertips: by the user, kept for the next time the same hand is connected, and offered then.

use crate::app::ctx::Ctx;
use crate::app::hands::Hand;
use crate::app::notices::NoticeKind;
use crate::app::readings::Freshness;
use crate::app::settings::Settings;
use crate::hand::{Finger, Moment};
use crate::store::calendar::since_1970;
use crate::transport::Endpoint;

/// Counts tactile channels from now, where the reading is fresh: one fingertip, or all. Refused where one is touched.
pub(super) fn tare(hand: &mut Hand, finger: Option<Finger>, ctx: &mut Ctx<'_>) {
    let mut fresh = fresh_tips(hand, ctx.now);
    fresh.retain(|each| finger.is_none_or(|finger| finger == *each));
    let readings = &mut hand.readings;
    if let Err((finger, newtons)) = readings.tare.tare(fresh, &readings.sample) {
        ctx.notify(NoticeKind::TareUnderLoad { finger, newtons });
    }
}

/// Counts from the taring that was kept, where the reading is fresh. Refused where one fingertip is touched.
pub(super) fn take_kept(hand: &mut Hand, ctx: &mut Ctx<'_>) {
    let fresh = fresh_tips(hand, ctx.now);
    let readings = &mut hand.readings;
    let taken = readings.tare.apply_stored(fresh, &readings.sample, ctx.now);
    if let Err((finger, newtons)) = taken {
        ctx.notify(NoticeKind::TareUnderLoad { finger, newtons });
    }
}

fn fresh_tips(hand: &Hand, now: Moment) -> Vec<Finger> {
    let is_live = hand.connection.is_live();
    let freshness = |finger| hand.readings.tip_freshness(finger, is_live, now);
    let is_fresh = |finger: &Finger| freshness(*finger) == Freshness::Live;
    Finger::ALL.into_iter().filter(is_fresh).collect()
}

/// Puts what the user tared into the settings.
pub(super) fn keep(hand: &Hand, settings: &mut Settings, now: Moment) {
    if let Some(tared) = tared_hand(hand) {
        settings.keep_tare(tared, hand.readings.tare.to_keep(since_1970(), now));
    }
}

/// Once a connection: offers what was kept of the same hand. Applies nothing.
pub(super) fn offer(hand: &mut Hand, settings: &Settings, now: Moment) {
    if hand.connection.is_live() && !hand.readings.tare.was_offered() {
        let kept = tared_hand(hand).and_then(|hand| settings.tares.get(&hand));
        hand.readings.tare.offer(kept.cloned(), since_1970(), now);
    }
}

/// The hand as files are kept by it: its place and id. The built-in one is none.
fn tared_hand(hand: &Hand) -> Option<String> {
    let endpoint = hand.connection.endpoint.as_ref();
    let (place, id) = endpoint
        .filter(|it| !it.is_sim())
        .map(Endpoint::place_and_id)?;
    Some(format!("{place} id {id}"))
}
