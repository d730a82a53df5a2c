//! Measured overshoot of a drive past its force threshold. No state.
//!
//! Measured on one hand of the family, index finger on a rigid block. FORCE_SET stops a
//! drive; it does not regulate force, so a fast finger hits far harder than its threshold.

use crate::hand::units::{Force, Speed};

/// Stiffness of the block used for the table, g per position count.
pub const RIGID_G_PER_COUNT: f64 = 40.0;

/// Lowest measured speed: the remedy for an overshoot that is too large.
pub const SLOWEST: f64 = 25.0;

/// Thresholds of the table's columns, g.
const THRESHOLDS: [f64; 5] = [100.0, 250.0, 500.0, 750.0, HIGHEST_G];
/// Highest measured threshold, g: above it the table is flat.
pub const HIGHEST_G: f64 = 1000.0;
/// Median peak above the threshold in g; rows are speeds 25, 250 and 1000.
const PEAKS: [[f64; 5]; 3] = [
    [7.0, 29.0, 64.0, 73.0, 69.0],
    [36.0, 336.0, 637.0, 1108.0, 1640.0],
    [36.0, 3263.0, 2917.0, 2865.0, 2502.0],
];
/// The same for a fast approach that was slowed to speed 25 before the contact.
const TWO_STAGE: [f64; 5] = [2.0, 25.0, 39.0, 71.0, 92.0];
/// Speeds and their row. 100 and 500 were measured at 500 g only; they interpolate between the rows.
const ROWS: [(f64, f64); 5] = [
    (SLOWEST, 0.0),
    (100.0, 0.24),
    (250.0, 1.0),
    (500.0, 1.8),
    (1000.0, 2.0),
];

/// Peak above the threshold in g, on a rigid block, for a contact at `speed` (units of SPEED_SET).
pub fn overshoot_g(speed: f64, threshold_g: f64) -> f64 {
    let at_row = |row: &[f64; 5]| interpolate(THRESHOLDS.into_iter().zip(*row), threshold_g);
    let [slow, middle, fast] = &PEAKS;
    let rows = [
        (0.0, at_row(slow)),
        (1.0, at_row(middle)),
        (2.0, at_row(fast)),
    ];
    let peak = interpolate(rows, interpolate(ROWS, speed));
    // Below the lowest measured speed, the peak falls to zero with the speed.
    let slower = (speed / SLOWEST).clamp(0.0, 1.0);
    let lighter = (threshold_g / 100.0).clamp(0.0, 1.0);
    peak * slower * lighter
}

/// The same for a fast approach that was slowed to `speed` before the contact.
pub fn two_stage_overshoot_g(speed: f64, threshold_g: f64) -> f64 {
    if speed > SLOWEST {
        return overshoot_g(speed, threshold_g);
    }
    let peak = interpolate(THRESHOLDS.into_iter().zip(TWO_STAGE), threshold_g);
    let lighter = (threshold_g / 100.0).clamp(0.0, 1.0);
    peak * (speed / SLOWEST).clamp(0.0, 1.0) * lighter
}

/// Speeds and overshoot in grams at a threshold of 500 g on another hand of the family (arXiv 2603.08988, middle finger). At smaller
/// thresholds the overshoot was as large.
const SECOND_HAND: [(f64, f64); 4] = [(0.0, 0.0), (SLOWEST, 24.0), (50.0, 325.0), (1000.0, 1056.0)];

/// Peak above the threshold in g on a second hand, for a contact at `speed`.
pub fn second_hand_overshoot_g(speed: f64) -> f64 {
    interpolate(SECOND_HAND, speed)
}

/// Overshoot of which the user should know beforehand: as much as the gentle threshold itself.
pub const NOTABLE_G: f64 = 500.0;

/// Lowest speed at which a contact on a rigid block overshoots this threshold by [`NOTABLE_G`]; `None` if none does.
pub fn rough_from_speed(threshold: Force) -> Option<Speed> {
    let threshold = f64::from(threshold.get());
    let rough = |speed: i16| overshoot_g(f64::from(speed), threshold) >= NOTABLE_G;
    first(Speed::MAX.get(), rough).and_then(|speed| Speed::new(speed).ok())
}

/// Smallest threshold that a contact on a rigid block at this speed overshoots by [`NOTABLE_G`]; `None` if there is none.
pub fn rough_from_threshold(speed: Speed) -> Option<Force> {
    let speed = f64::from(speed.get());
    let rough = |threshold: i16| overshoot_g(speed, f64::from(threshold)) >= NOTABLE_G;
    // Above 250 g the peaks of the fast rows fall a little; they stay far above [`NOTABLE_G`].
    first(Force::MAX.get(), rough).and_then(|force| Force::new(force).ok())
}

/// Smallest number up to `most` for which `holds` is true, if it is true from some number upwards.
pub(crate) fn first(most: i16, holds: impl Fn(i16) -> bool) -> Option<i16> {
    let (mut low, mut high) = (0, most);
    if !holds(high) {
        return None;
    }
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(low)
}

/// Linear interpolation between points in ascending order; constant outside them.
fn interpolate(points: impl IntoIterator<Item = (f64, f64)>, x: f64) -> f64 {
    let mut before: Option<(f64, f64)> = None;
    for (at, value) in points {
        if x <= at {
            return match before {
                Some((x0, y0)) => y0 + (value - y0) * (x - x0) / (at - x0),
                None => value,
            };
        }
        before = Some((at, value));
    }
    before.map_or(0.0, |(_, value)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measured_points_come_back() {
        for (speed, threshold, peak) in [
            (25.0, 100.0, 7.0),
            (250.0, 500.0, 637.0),
            (1000.0, 250.0, 3263.0),
            (1000.0, 5000.0, 2502.0),
            (0.0, 500.0, 0.0),
        ] {
            assert!((overshoot_g(speed, threshold) - peak).abs() < 1e-6);
        }
        for (speed, peak) in [
            (25.0, 24.0),
            (50.0, 325.0),
            (1000.0, 1056.0),
            (2000.0, 1056.0),
        ] {
            assert!((second_hand_overshoot_g(speed) - peak).abs() < 1e-6);
        }
        assert!((overshoot_g(100.0, 500.0) - 202.0).abs() < 5.0);
        assert!((overshoot_g(500.0, 500.0) - 2466.0).abs() < 30.0);
    }

    #[test]
    fn a_fast_approach_that_ends_slowly_has_a_row_of_its_own() {
        for (threshold, peak) in [(100.0, 2.0), (500.0, 39.0), (1000.0, 92.0)] {
            assert!((two_stage_overshoot_g(25.0, threshold) - peak).abs() < 1e-6);
        }
        assert!((two_stage_overshoot_g(250.0, 500.0) - 637.0).abs() < 1e-6);
    }

    #[test]
    fn the_rough_zone_begins_where_the_table_says() {
        let speed = |threshold: i16| rough_from_speed(Force::nearest(threshold)).map(Speed::get);
        assert_eq!(speed(0), None);
        assert_eq!(speed(100), None);
        let at_500 = speed(500);
        assert!(
            at_500.is_some_and(|speed| (200..250).contains(&speed)),
            "{at_500:?}"
        );
        let at_1000 = speed(1000);
        assert!(at_1000 < at_500);
        let threshold = |speed: i16| rough_from_threshold(Speed::nearest(speed)).map(Force::get);
        assert_eq!(threshold(25), None);
        assert!(threshold(1000) < threshold(250));
    }

    #[test]
    fn once_rough_it_stays_rough() {
        for threshold in (0..=3000).step_by(50) {
            let rough =
                |speed: i16| overshoot_g(f64::from(speed), f64::from(threshold)) >= NOTABLE_G;
            let flips = (1..=1000)
                .filter(|speed| rough(*speed) != rough(speed - 1))
                .count();
            assert!(flips <= 1, "threshold {threshold}: {flips}");
        }
        for speed in (0..=1000).step_by(20) {
            let rough =
                |threshold: i16| overshoot_g(f64::from(speed), f64::from(threshold)) >= NOTABLE_G;
            let flips = (1..=3000)
                .filter(|force| rough(*force) != rough(force - 1))
                .count();
            assert!(flips <= 1, "speed {speed}: {flips}");
        }
    }
}
