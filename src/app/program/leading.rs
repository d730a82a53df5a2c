//! One hand of the window that leads another: choosing the watched hand, the condition for leading, and the effect of a stop.

use crate::app::env::Env;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::inputs::mirror::MirrorScale;
use crate::record::{Disarmed, LinkState};

/// Makes the shown hand watch another one, or none. Watching moves nothing; a hand that was led until now is stopped.
pub(super) fn watch_hand(state: &mut State, wanted: Option<(SlotId, MirrorScale)>, env: &Env) {
    let _entered = env.runtime.enter();
    let own = state.hand().label.slot;
    let leader = wanted.and_then(|(leader, scale)| {
        let mut others = state.hands.iter().filter(|hand| hand.label.slot != own);
        let link = others
            .find(|hand| hand.label.slot == leader)?
            .connection
            .link()?;
        Some((leader, link.clone(), scale))
    });
    let hand = state.hand_mut();
    let leader = leader.filter(|_| hand.connection.open.is_some());
    let leader = leader.as_ref();
    hand.inputs
        .watch_hand(leader.map(|(slot, link, scale)| (*slot, link, *scale)));
}

/// True if the watched hand may lead the shown one: it must not be led by it.
pub(super) fn may_be_led(state: &State) -> bool {
    let shown = state.hands.shown();
    let mirror = shown.inputs.mirror.as_ref();
    mirror.is_some_and(|mirror| !state.hands.is_circle(mirror.leader, shown.label.slot))
}

/// Stops a hand whose leader is being stopped: it would otherwise continue to the leader's position.
pub(super) fn stop_mirrored(state: &mut State) {
    let stopping = state.hands.iter().filter(|hand| {
        let let_go = hand.connection.status.disarmed == Some(Disarmed::Released);
        hand.connection.status.state == LinkState::Holding && !let_go
    });
    let stopping: Vec<SlotId> = stopping.map(|hand| hand.label.slot).collect();
    for hand in state.hands.iter() {
        let leader = hand.leader();
        if leader.is_some_and(|leader| stopping.contains(&leader)) {
            hand.connection.end_outside(Disarmed::Stop);
        }
    }
}
