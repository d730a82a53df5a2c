//! One hand of the window that leads another: which one is watched, who may lead, and what a stop of it means.

use crate::app::env::Env;
use crate::app::hand::slot::SlotId;
use crate::app::inputs::mirror::HandMirror;
use crate::app::state::State;
use crate::inputs::mirror::MirrorScale;
use crate::record::{Disarmed, LinkState};

impl State {
    /// The shown hand watches another one, or none any more. Nothing moves by that; a hand that was led until now is stopped.
    pub(crate) fn watch_hand(&mut self, wanted: Option<(SlotId, MirrorScale)>, env: &Env) {
        let _entered = env.runtime.enter();
        let own = self.hand().label.slot;
        let mirror = wanted.and_then(|(leader, scale)| {
            let mut others = self.hands.iter().filter(|hand| hand.label.slot != own);
            let open = others
                .find(|hand| hand.label.slot == leader)?
                .open
                .as_ref()?;
            Some(HandMirror::open((leader, &open.link), scale))
        });
        let hand = self.hand_mut();
        hand.inputs.mirror = mirror.filter(|_| hand.open.is_some());
    }

    /// The hand that is watched leads the shown one from now on, unless that one leads it.
    pub(crate) fn start_mirror(&mut self, env: &Env) {
        let Self {
            hands, settings, ..
        } = self;
        let shown = hands.shown();
        let mirror = shown.inputs.mirror.as_ref();
        let leads = |mirror: &HandMirror| !hands.is_circle(mirror.leader, shown.label.slot);
        if mirror.is_some_and(leads) {
            hands.shown_mut().grant_mirror(settings, env);
        }
    }

    /// Stops a hand whose leader is told to stop: it would still go to where that one is.
    pub(crate) fn stop_mirrored(&mut self) {
        let stopping = self.hands.iter().filter(|hand| {
            let let_go = hand.link.disarmed == Some(Disarmed::Released);
            hand.link.state == LinkState::Holding && !let_go
        });
        let stopping: Vec<SlotId> = stopping.map(|hand| hand.label.slot).collect();
        for hand in self.hands.iter() {
            let leader = hand.inputs.leader();
            if leader.is_some_and(|leader| stopping.contains(&leader)) {
                hand.end_outside(Disarmed::Stop);
            }
        }
    }
}
