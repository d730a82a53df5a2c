//! Hold to run: motion passes only while the user holds a key. Let go, out of focus or in a window that hangs, the hand is stopped.

use crate::hand::Moment;
use crate::link::HoldToRun;
use std::time::Duration;

/// A key that was held is believed for so long: a window that draws slowly does not stop the hand, one that hangs does.
const HOLD_DURATION: Duration = Duration::from_millis(250);

/// What the user does with the key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum HoldKey {
    /// It was pressed just now: the user's wish to arm.
    Pressed,
    /// It is still held.
    Held,
    /// It is not held.
    LetGo,
}

/// What the user holds.
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

    /// True while it is believed to be held.
    pub(crate) fn is_held(&self, now: Moment) -> bool {
        self.until > now
    }

    /// Whether it has to be held at all.
    pub(crate) const fn need(&mut self, is_needed: bool) {
        self.is_needed = is_needed;
    }

    /// What the user does with it; true while somebody who pressed it waits to be armed.
    pub(crate) fn take(&mut self, key: HoldKey, now: Moment) -> bool {
        let until = now.plus(HOLD_DURATION);
        (self.until, self.is_pressed) = match key {
            HoldKey::Pressed => (until, true),
            HoldKey::Held => (until, self.is_pressed),
            HoldKey::LetGo => (Moment::ZERO, false),
        };
        self.is_needed && self.is_pressed
    }

    /// What the link is told of it.
    pub(crate) const fn hold_to_run(&self) -> HoldToRun {
        match (self.is_needed, self.until) {
            (false, _) => HoldToRun::Off,
            (true, Moment::ZERO) => HoldToRun::Released,
            (true, until) => HoldToRun::Held(until),
        }
    }

    /// Only who presses again arms.
    pub(crate) const fn forget_press(&mut self) {
        self.is_pressed = false;
    }
}
