//! Hold to run: motion passes only while the user holds a key. When the key is released, the window loses focus or the window hangs,
//! the hand is stopped.

use crate::hand::Moment;
use crate::link::HoldToRun;
use std::time::Duration;

/// A held key stays valid for this long: a window that draws slowly does not stop the hand, a window that hangs does.
const HOLD_DURATION: Duration = Duration::from_millis(250);

/// State of the key, as the window reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum HoldKey {
    /// It was just pressed: the user requests arming.
    Pressed,
    /// It is still held.
    Held,
    /// It is not held.
    LetGo,
}

/// State of the hold-to-run key.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HeldKey {
    is_needed: bool,
    until: Moment,
    /// The key was pressed, and this press has not armed yet.
    is_pressed: bool,
}

impl HeldKey {
    /// True if the key is required and not held.
    pub(crate) fn is_let_go(&self, now: Moment) -> bool {
        self.is_needed && self.until <= now
    }

    /// True while the key counts as held.
    pub(crate) fn is_held(&self, now: Moment) -> bool {
        self.until > now
    }

    /// Sets whether the key is required.
    pub(crate) const fn need(&mut self, is_needed: bool) {
        self.is_needed = is_needed;
    }

    /// Applies the state of the key; true while a press waits for arming.
    pub(crate) fn apply(&mut self, key: HoldKey, now: Moment) -> bool {
        let until = now.plus(HOLD_DURATION);
        (self.until, self.is_pressed) = match key {
            HoldKey::Pressed => (until, true),
            HoldKey::Held => (until, self.is_pressed),
            HoldKey::LetGo => (Moment::ZERO, false),
        };
        self.is_needed && self.is_pressed
    }

    /// State of the key for the link.
    pub(crate) const fn hold_to_run(&self) -> HoldToRun {
        match (self.is_needed, self.until) {
            (false, _) => HoldToRun::Off,
            (true, Moment::ZERO) => HoldToRun::Released,
            (true, until) => HoldToRun::Held(until),
        }
    }

    /// Discards the press: only a new press arms.
    pub(crate) const fn forget_press(&mut self) {
        self.is_pressed = false;
    }
}
