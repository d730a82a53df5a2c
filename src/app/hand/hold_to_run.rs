//! Who holds a key lets the hand move: what is done with it.

use crate::app::hand::HandState;
use crate::app::hand::held_key::HoldKey;
use crate::app::notices::Notices;
use crate::link::{HoldToRun, Owner};
use crate::record::ArmRefusal;

impl HandState {
    /// Whether the key is believed to be held.
    pub fn is_key_held(&self) -> bool {
        self.held.is_held(self.now)
    }

    /// Lets motion pass, or no more. Who presses is armed as soon as a stop before is confirmed.
    pub(crate) fn hold_key(&mut self, key: HoldKey, notices: &mut Notices) {
        let wants_to_arm = self.held.take(key, self.now);
        self.tell_held();
        if !wants_to_arm || self.arm_refusal() == Some(ArmRefusal::Holding) {
            return;
        }
        self.held.forget_press();
        // Who was let move the hand from outside arms by itself.
        if self.outside_owner().is_none() {
            self.arm(notices);
        }
    }

    /// Time goes on; whether anything has to be held may have been changed.
    pub(crate) fn tick_hold(&mut self, is_needed: bool) {
        self.held.need(is_needed);
        self.tell_held();
    }

    /// What has to be held now. A gamepad has a button of its own for that, and an exhibition is for strangers.
    pub(crate) fn hold_to_run(&self) -> HoldToRun {
        match self.link.holder.map(|holder| holder.owner) {
            Some(Owner::Gamepad | Owner::Exhibition) => HoldToRun::Off,
            _ => self.held.hold_to_run(),
        }
    }

    fn tell_held(&self) {
        if let Some(open) = &self.open {
            open.link.hold_to_run(self.hold_to_run());
        }
    }
}
