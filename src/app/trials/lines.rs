//! Plot lines of a trial: each quantity decimated to few points that retain every peak. Computed once, when the trial
//! ends.

use crate::hand::Dof;
use crate::trials::JointMetrics;
use crate::trials::measure::curve::JointCurves;
use crate::trials::recording::TrialRecording;

/// Maximum number of points per line: two for each of more columns than a plot has pixels.
const POINTS_MAX: usize = 1000;

/// Quantity by which trials are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TrialQuantity {
    /// Force above the reading at rest, g.
    #[default]
    Force,
    /// ANGLE_ACT.
    Angle,
    /// Current, mA.
    Current,
    /// Normal force of the fingertip, N.
    Touch,
}

impl TrialQuantity {
    /// All quantities, in the order of the variants.
    pub const ALL: [Self; 4] = [Self::Force, Self::Angle, Self::Current, Self::Touch];
}

/// Lines of one joint. Times are seconds from the closing command.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLines {
    pub dof: Dof,
    /// Time of contact with the object; `None` if none was detected.
    pub contact_s: Option<f64>,
    /// Indexed by the order of [`TrialQuantity::ALL`].
    points: [Vec<[f64; 2]>; 4],
}

impl JointLines {
    /// Computes the lines from a recording and its metrics.
    pub fn of(recording: &TrialRecording, joint: &JointMetrics) -> Self {
        let curves = JointCurves::of(recording, joint.dof);
        let rest_g = joint.rest_force_g.unwrap_or(0.0);
        let force = curves.force.less(rest_g);
        let shown = [&force, &curves.angle, &curves.current, &curves.normal];
        Self {
            dof: joint.dof,
            contact_s: joint.time_to_contact_s.or(joint.time_to_touch_s),
            points: shown.map(|curve| curve.decimated(POINTS_MAX)),
        }
    }

    /// Points of (seconds, value) of a quantity; empty if it was not read.
    pub fn points(&self, quantity: TrialQuantity) -> &[[f64; 2]] {
        let points = self.points.get(quantity as usize);
        points.map_or(&[], Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trials::measure::curve::TimeSeries;

    #[test]
    fn a_thinned_line_is_short_and_keeps_its_peak() {
        let curve: TimeSeries = (0..90_000)
            .map(|n| (f64::from(n), if n == 45_678 { 2000.0 } else { 3.0 }))
            .collect();
        let points = curve.decimated(POINTS_MAX);
        assert!(points.len() <= POINTS_MAX);
        let column_s = 2.0 * 90_000.0 / 500.0;
        let is_peak = |[t, v]: &[f64; 2]| (t - 45_678.0).abs() < column_s && *v == 2000.0;
        assert!(points.iter().any(is_peak), "{points:?}");
        assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }
}
