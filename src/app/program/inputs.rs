//! Inputs from outside the window that may move a hand: opening them, granting and ending control, and their results.

use crate::app::env::Ctx;
use crate::app::env::Env;
use crate::app::hand::Hand;
use crate::app::hand::running::MotionRun;
use crate::app::inputs::{FollowRun, InputAction};
use crate::app::notices::NoticeKind;
use crate::app::poses::PoseState;
use crate::app::program::leading;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Moment, Setpoints};
use crate::inputs::pad::file;
use crate::link::Owner;
use crate::motion::follow::{FollowStart, FollowTerms};
use crate::motion::source::{Source, SourceKind};
use crate::record::{ArmRefusal, Disarmed};
use crate::share::fleet::{self, FleetCard};
use crate::share::gateway::Gateway;
use crate::transport::dds::DdsPlace;

/// Carries out a user action on the shown hand.
pub(super) fn act(state: &mut State, action: InputAction, env: &Env) {
    let (may_be_led, now) = (leading::may_be_led(state), state.now);
    let State {
        hands, settings, ..
    } = state;
    let hand = hands.shown_mut();
    let (side, connection) = (hand.side, &hand.connection);
    // The user's limits are the most that a message may request.
    let allowed = hand.controls.limits();
    match action {
        InputAction::Listen(place) => {
            hand.inputs.listen(place, connection, (side, allowed), env);
        }
        InputAction::ReadPad(on) => {
            hand.inputs.read_pad(on, connection, (settings, side), env);
        }
        InputAction::Share(place) => hand.inputs.share(place, connection, settings, env),
        InputAction::Show(place) => hand.inputs.show_viewers(place, connection, side, env),
        InputAction::JoinDds(interface) => {
            let card = fleet_card(hand, settings);
            let domain = 0;
            let place = interface.map(|interface| (DdsPlace { interface, domain }, card));
            hand.inputs.join_dds(place, allowed, connection, env);
        }
        InputAction::Mirror(wanted) => leading::watch_hand(state, wanted, env),
        InputAction::Grant(SourceKind::Mirror) if !may_be_led => {}
        InputAction::Grant(source) => follow(hand, source, settings, (env, now)),
        InputAction::GrantClient(client) => {
            let gateway = hand.inputs.gateway.as_ref();
            if let Some(gateway) = gateway.filter(|_| hand.activity().lets_grant()) {
                gateway.grant(client);
            }
        }
        InputAction::TakeBack => connection.end_outside(Disarmed::Person),
        InputAction::Limit(limits) => settings.follow = limits.within(),
        InputAction::Map(map) => {
            settings.pad_map = Some(file::write(&map));
            // Controls that are held have to be pressed again.
            if hand.inputs.source(SourceKind::Pad).is_some() {
                hand.inputs
                    .read_pad(true, connection, (settings, side), env);
            }
        }
    }
}

/// Grants control to a source; whatever moved the hand before loses it.
fn follow(hand: &mut Hand, kind: SourceKind, settings: &Settings, (env, now): (&Env, Moment)) {
    let Some((source, owner)) = hand.inputs.offered(kind, now) else {
        return;
    };
    let refusal = hand.arm_refusal(now);
    let is_refused = refusal.is_some_and(|refusal| refusal != ArmRefusal::LetGo);
    if is_refused || !hand.activity().lets_grant() {
        return;
    }
    let terms = terms(hand, settings);
    let Some(link) = hand.connection.link() else {
        return;
    };
    let lease = link.grant(owner);
    // An armed hand may have the speed and force of a played entry: the new source starts with the user's.
    let armed = hand.connection.status.armed;
    if let Some(mut own) = armed.map(Setpoints::none) {
        hand.controls.restore_limits(&mut own, |_| true);
        // A refused lease has ended and accepts nothing.
        let _sent = (!own.is_empty()).then(|| link.set(lease, &own));
    }
    let arm = hand.controls.arm_request(&hand.readings.sample);
    let start = |terms| FollowStart {
        lease,
        terms,
        arm,
        grip: hand.readings.grip.clone(),
        overshoot: OvershootMap::clone(&hand.overshoot.map),
        blocks: settings.size_blocks(hand.connection.endpoint.as_ref()),
        seen: hand.readings.sample,
        clock: env.clock,
    };
    let run = FollowRun::begin((source, owner), link.clone(), start, (terms, env));
    hand.running.0 = Some(MotionRun::Follow(run));
}

fn terms(hand: &Hand, settings: &Settings) -> FollowTerms {
    FollowTerms {
        limits: settings.follow,
        locked: hand.controls.locked(),
        hold: hand.connection.holds(hand.controls.held.hold_to_run()),
    }
}

/// Applies news of inputs and clients.
pub(super) fn tick(hand: &mut Hand, settings: &Settings, poses: &PoseState, ctx: &mut Ctx<'_>) {
    let terms = terms(hand, settings);
    let (card, follows_dds) = (fleet_card(hand, settings), hand.running.follows(Owner::Dds));
    let inputs = &mut hand.inputs;
    if let Some(Source::Pad(pad)) = inputs.source(SourceKind::Pad) {
        pad.set_poses(poses.on_pad(&settings.pad_map(), &settings.hidden_poses));
    }
    inputs.refresh();
    if let Some(source @ Source::Dds(joined)) = inputs.source(SourceKind::Dds) {
        joined.shared.announce(card);
        if follows_dds && source.other_follower().is_some() {
            // Each program sees the other, and both stop.
            hand.connection.end_outside(Disarmed::Stop);
        }
    }
    let Some(MotionRun::Follow(run)) = &mut hand.running.0 else {
        return;
    };
    let (views, end) = run.task.news();
    let owner = run.owner;
    run.terms
        .send_if_modified(|told| std::mem::replace(told, terms) != terms);
    if let Some((_, view)) = views.into_iter().last() {
        run.view = Some(view);
        hand.connection.commanded |= view.sent.iter().any(|(_, to)| to.is_some());
        hand.controls.show_angles(view.sent);
    }
    if let Some(outcome) = end {
        hand.running.0 = None;
        if outcome.leader_stopped {
            ctx.notify(NoticeKind::LeaderStopped);
        }
        if outcome.end.is_ok() {
            ctx.notify(NoticeKind::SourceSilent(owner));
        }
        hand.follow();
    }
}

/// Description of this hand for other programs on the network.
fn fleet_card(hand: &Hand, settings: &Settings) -> FleetCard {
    FleetCard {
        host: fleet::host(),
        name: hand.label.name.to_string(),
        side: hand.side,
        at: hand.inputs.gateway.as_ref().map(Gateway::address),
        first_may_move: settings.first_client_moves,
        follows: hand.running.follows(Owner::Dds),
    }
}
