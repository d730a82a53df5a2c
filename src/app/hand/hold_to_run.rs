//! Hold to run: motion passes only while a person holds a key. Let go, out of focus or in a window that hangs, the hand is stopped.

use crate::app::hand::HandState;
use crate::app::notices::Notices;
use crate::hand::Moment;
use crate::link::{HoldToRun, Owner};
use crate::record::ArmRefusal;
use std::time::Duration;

/// A key that was held is believed for so long: a window that draws slowly does not stop the hand, one that hangs does.
const HELD_FOR: Duration = Duration::from_millis(250);

/// What a person does with the key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HoldKey {
    /// It was pressed just now: a person's wish to arm.
    Pressed,
    /// It is still held.
    Held,
    /// It is not held.
    LetGo,
}

/// What a person holds.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HeldKey {
    is_needed: bool,
    until: Moment,
    /// It was pressed, and nothing was armed for that yet.
    is_pressed: bool,
}

impl HeldKey {
    /// True if it has to be held, and is not.
    pub(crate) fn is_let_go(&self, now: Moment) -> bool {
        self.is_needed && self.until <= now
    }

    /// Only who presses again arms.
    pub(crate) const fn forget_press(&mut self) {
        self.is_pressed = false;
    }
}

impl HandState {
    /// Whether the key is believed to be held.
    #[must_use]
    pub fn is_key_held(&self) -> bool {
        self.held.until > self.now
    }

    /// Lets motion pass, or no more. Who presses is armed as soon as a stop before is confirmed.
    pub(crate) fn hold_key(&mut self, key: HoldKey, notices: &mut Notices) {
        if !self.held.is_needed {
            return;
        }
        (self.held.until, self.held.is_pressed) = match key {
            HoldKey::Pressed => (self.now.plus(HELD_FOR), true),
            HoldKey::Held => (self.now.plus(HELD_FOR), self.held.is_pressed),
            HoldKey::LetGo => (Moment::ZERO, false),
        };
        self.tell_held();
        if !self.held.is_pressed || self.arm_refusal() == Some(ArmRefusal::Holding) {
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
        self.held.is_needed = is_needed;
        self.tell_held();
    }

    /// What has to be held now. A gamepad has a button of its own for that, and an exhibition is for strangers.
    pub(crate) fn hold_to_run(&self) -> HoldToRun {
        let owner = self.link.holder.map(|holder| holder.owner);
        let is_own = matches!(owner, Some(Owner::Gamepad | Owner::Exhibition));
        match (self.held.is_needed && !is_own, self.held.until) {
            (false, _) => HoldToRun::Off,
            (true, Moment::ZERO) => HoldToRun::Released,
            (true, until) => HoldToRun::Held(until),
        }
    }

    fn tell_held(&self) {
        if let Some(open) = &self.open {
            open.link.hold_to_run(self.hold_to_run());
        }
    }
}
