//! The 24 V supply of the simulated hand: switched on and off, or failing on its own. Holds no state of the hand.

use crate::sim::personality::Power;
use std::ops::Range;

/// Period in which a failing supply is off.
const FAILS_MS: Range<u64> = 3000..3500;

/// Power supply of the hand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Supply {
    kind: Power,
    switched_off: bool,
}

impl Supply {
    /// Creates a supply that is switched on.
    pub(crate) const fn new(kind: Power) -> Self {
        Self {
            kind,
            switched_off: false,
        }
    }

    pub(crate) const fn switch_off(&mut self) {
        self.switched_off = true;
    }

    pub(crate) const fn switch_on(&mut self) {
        self.switched_off = false;
    }

    /// True if the hand has no power at this time.
    pub(crate) fn is_off(self, now_ms: u64) -> bool {
        self.switched_off || self.kind == Power::Cut && FAILS_MS.contains(&now_ms)
    }

    /// True in the first millisecond of a failing supply's outage.
    pub(crate) fn fails(self, now_ms: u64) -> bool {
        self.kind == Power::Cut && now_ms == FAILS_MS.start
    }
}
