//! What is drawn of a trial: few points of each quantity, with every peak. Made once, when the trial is over.

use crate::app::trial::curve::{Curve, JointCurves};
use crate::app::trial::metrics::{JointMetrics, TrialMetrics};
use crate::app::trial::recording::Recording;
use crate::hand::Dof;

/// Pieces that a line is cut into, each kept by its lowest and highest point: more than a plot has pixels.
const PIECES: usize = 500;

/// A quantity that trials are compared by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shown {
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

impl Shown {
    /// All.
    pub const ALL: [Self; 4] = [Self::Force, Self::Angle, Self::Current, Self::Touch];
}

/// The lines of one joint. Times are seconds from the closing command.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLines {
    /// The joint.
    pub dof: Dof,
    /// When it met the object; `None` = it did not, as far as can be told.
    pub contact_s: Option<f64>,
    force: Vec<[f64; 2]>,
    angle: Vec<[f64; 2]>,
    current: Vec<[f64; 2]>,
    touch: Vec<[f64; 2]>,
}

impl JointLines {
    /// Seconds and values of a quantity; empty if it was not read.
    #[must_use]
    pub fn points(&self, shown: Shown) -> &[[f64; 2]] {
        match shown {
            Shown::Force => &self.force,
            Shown::Angle => &self.angle,
            Shown::Current => &self.current,
            Shown::Touch => &self.touch,
        }
    }
}

/// The lines of all joints that took part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lines(pub Vec<JointLines>);

impl Lines {
    /// Of a recording and what was measured from it.
    #[must_use]
    pub fn of(recording: &Recording, metrics: &TrialMetrics) -> Self {
        if recording.rows().is_empty() {
            return Self::default();
        }
        let joints = metrics.joints.iter();
        Self(joints.map(|joint| joint_lines(recording, joint)).collect())
    }
}

fn joint_lines(recording: &Recording, joint: &JointMetrics) -> JointLines {
    let curves = JointCurves::of(recording, joint.dof);
    let rest_g = joint.rest_force_g.unwrap_or(0.0);
    JointLines {
        dof: joint.dof,
        contact_s: joint.time_to_contact_s.or(joint.time_to_touch_s),
        force: thinned(&curves.force.less(rest_g)),
        angle: thinned(&curves.angle),
        current: thinned(&curves.current),
        touch: thinned(&curves.normal),
    }
}

/// The lowest and the highest point of each piece, in their order.
fn thinned(curve: &Curve) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = curve.points().iter().map(|p| [p.t, p.v]).collect();
    thinned_to(&points, 2 * PIECES)
}

/// The lowest and the highest point of each piece, in their order: no more points than `most`, and never none of some.
pub(crate) fn thinned_to(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    if points.len() <= most {
        return points.to_vec();
    }
    let pieces = (most / 2).max(1);
    let mut kept = Vec::with_capacity(2 * pieces);
    for piece in points.chunks(points.len().div_ceil(pieces)) {
        let value = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let ends = [piece.iter().min_by(value), piece.iter().max_by(value)];
        let mut ends: Vec<[f64; 2]> = ends.into_iter().flatten().copied().collect();
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        ends.dedup();
        kept.extend(ends);
    }
    kept
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    #[test]
    fn a_thinned_line_is_short_and_keeps_its_peak() {
        let curve: Curve = (0..90_000)
            .map(|n| (f64::from(n), if n == 45_678 { 2000.0 } else { 3.0 }))
            .collect();
        let points = thinned(&curve);
        assert!(points.len() <= 2 * PIECES);
        assert!(points.contains(&[45_678.0, 2000.0]));
        assert!(points.windows(2).all(|pair| pair.first() < pair.last()));
    }
}
