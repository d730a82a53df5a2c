//! How far a drive runs past its force threshold: the measured table. No state.
//!
//! Measured on one hand of the family, index finger on a rigid block. FORCE_SET stops a
//! drive; it does not regulate force, so a fast finger hits far harder than it was told.

/// Stiffness of the block that the table was measured on, g for each position count.
pub const RIGID_G_PER_COUNT: f64 = 40.0;

/// Thresholds of the table's columns, g.
const THRESHOLDS: [f64; 5] = [100.0, 250.0, 500.0, 750.0, 1000.0];
/// Median peak above the threshold in g; rows are speeds 25, 250 and 1000.
const PEAKS: [[f64; 5]; 3] = [
    [7.0, 29.0, 64.0, 73.0, 69.0],
    [36.0, 336.0, 637.0, 1108.0, 1640.0],
    [36.0, 3263.0, 2917.0, 2865.0, 2502.0],
];
/// Speeds and the row they fall on. 100 and 500 were measured at 500 g only, and place the speeds between rows.
const ROWS: [(f64, f64); 5] = [
    (25.0, 0.0),
    (100.0, 0.24),
    (250.0, 1.0),
    (500.0, 1.8),
    (1000.0, 2.0),
];

/// Peak above the threshold in g, on a rigid block, for a contact at `speed` (units of SPEED_SET).
#[must_use]
pub fn overshoot_g(speed: f64, threshold_g: f64) -> f64 {
    let at_row = |row: &[f64; 5]| interpolate(THRESHOLDS.into_iter().zip(*row), threshold_g);
    let [slow, middle, fast] = &PEAKS;
    let rows = [
        (0.0, at_row(slow)),
        (1.0, at_row(middle)),
        (2.0, at_row(fast)),
    ];
    let peak = interpolate(rows, interpolate(ROWS, speed));
    // Below the slowest that was measured, the peak goes to zero with the speed.
    let slower = (speed / 25.0).clamp(0.0, 1.0);
    let lighter = (threshold_g / 100.0).clamp(0.0, 1.0);
    peak * slower * lighter
}

/// Linear between points in rising order; flat outside them.
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
        assert!((overshoot_g(100.0, 500.0) - 202.0).abs() < 5.0);
        assert!((overshoot_g(500.0, 500.0) - 2466.0).abs() < 30.0);
    }
}
