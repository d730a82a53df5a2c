//! What a grip's state is told by: one named number for each decision.

use std::time::Duration;

/// Where one state of a grip ends and another begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripThresholds {
    /// A finger at rest is open from this angle on, 0..=1000; below it, it is closed.
    pub open_from: u16,
    /// Force over the joint's own zero from which it touches something, g. Below half of it, it does not.
    pub contact_g: u16,
    /// Normal force of the fingertip from which it touches something, N. Below half of it, it does not.
    pub contact_n: f32,
    /// Force from which it presses too hard, g; the fingertip's newtons count likewise.
    pub too_hard_g: u16,
    /// Current from which a drive with contact presses too hard, mA.
    pub too_hard_ma: u16,
    /// Rise of tangential by normal force over that of the half second before that is a slip.
    pub slip_ratio: f64,
    /// Turn of the tangential force that is a slip, degrees.
    pub slip_turn_deg: f64,
    /// Contact is lost if it stays away for so long and the finger did not open, ms.
    pub lost_after_ms: u16,
    /// Older readings are no evidence, ms.
    pub fresh_ms: u16,
    /// Fingers that must hold for the grasp to hold, 1..=5; 2 for a pinch.
    pub least_fingers: u8,
}

impl Default for GripThresholds {
    fn default() -> Self {
        Self {
            open_from: 900,
            contact_g: 60,
            contact_n: 0.2,
            too_hard_g: 2000,
            too_hard_ma: 1900,
            slip_ratio: 0.12,
            slip_turn_deg: 25.0,
            lost_after_ms: 40,
            fresh_ms: 500,
            least_fingers: 1,
        }
    }
}

impl GripThresholds {
    /// How long a reading counts.
    pub const fn fresh_for(&self) -> Duration {
        Duration::from_millis(self.fresh_ms as u64)
    }

    /// How long contact must stay away to be lost.
    pub const fn lost_after(&self) -> Duration {
        Duration::from_millis(self.lost_after_ms as u64)
    }
}
