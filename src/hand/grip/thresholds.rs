//! What a grip's state is told by: one named number for each decision. A pose may have its own.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Where one state of a grip ends and another begins.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
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

/// A threshold that no hand can have.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} is {got}: it must be {least} to {most}")]
pub struct ThresholdOutOfRange {
    /// Its key.
    pub name: &'static str,
    /// What was given.
    pub got: f64,
    /// The smallest that makes sense.
    pub least: f64,
    /// The largest.
    pub most: f64,
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

    /// The same thresholds if all are possible.
    ///
    /// # Errors
    /// The first that is not.
    pub fn checked(self) -> Result<Self, ThresholdOutOfRange> {
        let rows = [
            ("open_from", f64::from(self.open_from), 0.0, 1000.0),
            ("contact_g", f64::from(self.contact_g), 5.0, 4000.0),
            ("contact_n", f64::from(self.contact_n), 0.01, 40.0),
            ("too_hard_g", f64::from(self.too_hard_g), 5.0, 4000.0),
            ("too_hard_ma", f64::from(self.too_hard_ma), 1.0, 2000.0),
            ("slip_ratio", self.slip_ratio, 0.01, 10.0),
            ("slip_turn_deg", self.slip_turn_deg, 1.0, 180.0),
            ("lost_after_ms", f64::from(self.lost_after_ms), 0.0, 5000.0),
            ("fresh_ms", f64::from(self.fresh_ms), 50.0, 5000.0),
            ("least_fingers", f64::from(self.least_fingers), 1.0, 5.0),
        ];
        let wrong = rows
            .into_iter()
            .find(|(_, got, least, most)| !(*least..=*most).contains(got));
        match wrong {
            None => Ok(self),
            Some((name, got, least, most)) => Err(ThresholdOutOfRange {
                name,
                got,
                least,
                most,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_possible_and_what_is_not_is_named() {
        let usual = GripThresholds::default();
        assert_eq!(usual.checked(), Ok(usual));
        let wrong = GripThresholds {
            contact_n: f32::NAN,
            ..usual
        };
        assert_eq!(wrong.checked().unwrap_err().name, "contact_n");
        let wrong = GripThresholds {
            least_fingers: 6,
            ..usual
        };
        let told = wrong.checked().unwrap_err().to_string();
        assert_eq!(told, "least_fingers is 6: it must be 1 to 5");
    }
}
