//! Carries out what a person does with the list of hands. What is done to one hand touches no other.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::held_key::HoldKey;
use crate::app::hand::slot::SlotId;
use crate::app::hands::action::HandsAction;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::transport::Endpoint;

impl State {
    /// Does what a person asked for.
    pub(crate) fn hands_action(&mut self, action: HandsAction, env: &Env) {
        match action {
            HandsAction::Add => {
                self.hands.add();
                self.hand_is_shown();
            }
            HandsAction::Show(slot) => {
                self.hands.show(slot);
                self.hand_is_shown();
            }
            HandsAction::Remove(slot) => self.remove_hand(slot, env),
            HandsAction::Name(slot, name) => {
                let hand = self.hands.iter().find(|hand| hand.label.slot == slot);
                if let Some(endpoint) = hand.and_then(|hand| hand.endpoint.as_ref()) {
                    self.settings.name_hand(endpoint, &name);
                }
            }
            HandsAction::StopOne(slot) => self.stop_hand(slot),
            HandsAction::PosesForAll(on) => self.hands.set_poses_for_all(on),
        }
    }

    /// A dry run began at the pose of the hand that was shown before.
    fn hand_is_shown(&mut self) {
        self.poses.preview = None;
        self.hands.shown_mut().apply_settings(&self.settings);
    }

    fn remove_hand(&mut self, slot: SlotId, env: &Env) {
        if !self.hands.is_several() {
            return;
        }
        let Self {
            hands,
            notices,
            now,
            ..
        } = self;
        let Some(hand) = hands.get_mut(slot) else {
            return;
        };
        hand.now = *now;
        notices.about(Some(&hand.label));
        hand.close_procedure();
        hand.leave(None, env, notices);
        hand.is_removed = true;
        self.drop_removed();
    }

    /// Takes away the slots of hands that were to go and are left by now.
    pub(crate) fn drop_removed(&mut self) {
        let is_gone = |hand: &&HandState| hand.is_removed && hand.open.is_none();
        let gone: Vec<SlotId> = self
            .hands
            .iter()
            .filter(is_gone)
            .map(|hand| hand.label.slot)
            .collect();
        for slot in gone {
            let was_shown = self.hands.shown().label.slot == slot;
            self.hands.remove(slot);
            if was_shown {
                self.hand_is_shown();
            }
        }
        for hand in self.hands.iter_mut().filter(|hand| hand.open.is_none()) {
            // The last one stays.
            hand.is_removed = false;
        }
    }

    fn stop_hand(&mut self, slot: SlotId) {
        let Self {
            hands,
            notices,
            now,
            ..
        } = self;
        let is_several = hands.is_several();
        if let Some(hand) = hands.get_mut(slot) {
            hand.now = *now;
            notices.about(is_several.then_some(&hand.label));
            hand.stop(notices);
        }
    }

    /// Holds every hand now. A slot without a hand has nothing to stop, unless there is nothing else.
    pub(crate) fn stop_all(&mut self) {
        let any = self.hands.iter().any(|hand| hand.endpoint.is_some());
        let shown = self.hands.shown().label.slot;
        let stops = |hand: &HandState| {
            if any {
                hand.endpoint.is_some()
            } else {
                hand.label.slot == shown
            }
        };
        let slots: Vec<SlotId> = self
            .hands
            .iter()
            .filter(|hand| stops(hand))
            .map(|hand| hand.label.slot)
            .collect();
        for slot in slots {
            self.stop_hand(slot);
        }
    }

    /// The key that is held lets every hand move that is armed; its press arms the shown one alone.
    pub(crate) fn hold_key(&mut self, key: HoldKey) {
        let State {
            hands,
            notices,
            now,
            ..
        } = self;
        let (shown, is_several) = (hands.shown().label.slot, hands.is_several());
        for hand in hands.iter_mut() {
            let key = match key {
                HoldKey::Pressed if hand.label.slot != shown => HoldKey::Held,
                key => key,
            };
            hand.now = *now;
            notices.about(is_several.then_some(&hand.label));
            hand.hold_key(key, notices);
        }
    }

    /// True if a slot, other than the one it is for, has this hand or the port that leads to it; the person is told.
    pub(crate) fn is_open_elsewhere(&mut self, endpoint: &Endpoint, own: Option<SlotId>) -> bool {
        let hands = self.hands.iter();
        let mut others = hands.filter(|hand| Some(hand.label.slot) != own);
        let Some(other) = others.find(|hand| hand.has(endpoint)) else {
            return false;
        };
        let told = NoticeKind::OpenElsewhere {
            endpoint: endpoint.to_string(),
            hand: other.label.name.to_string(),
        };
        self.notices.about(None);
        self.notices.push(self.now, told);
        true
    }
}

impl HandState {
    /// True if this endpoint leads to this hand, or through its port: a serial port has room for one.
    fn has(&self, endpoint: &Endpoint) -> bool {
        let going = self
            .leaving
            .as_ref()
            .and_then(|leaving| leaving.to.as_ref());
        let mut own = self.endpoint.iter().chain(going);
        own.any(|own| {
            let moved = self.link.moved_to.as_deref();
            let is_port = endpoint.port().is_some_and(|port| {
                own.port() == Some(port) || own.port().is_some() && moved == Some(port)
            });
            let is_same = !own.is_sim() && own.place_and_id() == endpoint.place_and_id();
            own == endpoint || is_port || is_same
        })
    }
}
