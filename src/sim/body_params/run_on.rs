//! Overshoot of a drive past its force threshold on two hands of the family. No state.

use crate::hand::impact::{overshoot_g, second_hand_overshoot_g, two_stage_overshoot_g};

/// A contact at which the force meets the threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MetThreshold {
    /// Speed in units of SPEED_SET.
    pub speed: f64,
    /// Force threshold, g.
    pub threshold_g: f64,
    /// True if the finger approached fast and slowed down before the contact.
    pub came_fast: bool,
}

/// Overshoot in grams on a block of [`crate::hand::impact::RIGID_G_PER_COUNT`]; `second` is the weight of the second
/// hand, 0 to 1.
pub fn run_on_g(met: MetThreshold, second: f64) -> f64 {
    let MetThreshold {
        speed, threshold_g, ..
    } = met;
    let first = if met.came_fast {
        two_stage_overshoot_g(speed, threshold_g)
    } else {
        overshoot_g(speed, threshold_g)
    };
    (1.0 - second) * first + second * second_hand_overshoot_g(speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_hands_are_at_the_ends_and_the_middle_is_between() {
        let met = |speed| MetThreshold {
            speed,
            threshold_g: 500.0,
            came_fast: false,
        };
        assert_eq!(run_on_g(met(250.0), 0.0), overshoot_g(250.0, 500.0));
        for (speed, grams) in [
            (25.0, 24.0),
            (50.0, 325.0),
            (1000.0, 1056.0),
            (2000.0, 1056.0),
        ] {
            assert_eq!(run_on_g(met(speed), 1.0), grams);
        }
        let half = run_on_g(met(25.0), 0.5);
        assert!((half - 44.0).abs() < 1e-9, "{half}");
    }
}
