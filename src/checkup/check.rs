//! A figure beside what it should be, and what it was.

use crate::checkup::kept::Kept;
use crate::checkup::measure::Measured;
use crate::checkup::subject::{Light, Subject};
use crate::checkup::trend::{Drift, Trend, TrendPoint};
use crate::hand::Dof;

/// One figure, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    pub measured: Measured,
    /// What it was at the first check-up of this hand, and at the last before this one.
    pub first: Option<f64>,
    pub last: Option<f64>,
    pub light: Light,
    /// Over the last check-ups; this one is the last.
    pub trend: Trend,
}

impl Check {
    /// Of a figure of now, and the earlier check-ups of this hand, the oldest first.
    pub fn of(measured: Measured, at: &str, earlier: &[Kept]) -> Self {
        let same = |own: &&Measured| (own.what, own.of) == (measured.what, measured.of);
        let find = |kept: &Kept| kept.figures.iter().find(same).and_then(|own| own.value);
        let first = earlier.first().and_then(find);
        let point = |at: &str, value: Option<f64>| {
            let at = at.to_owned();
            value.map(|value| TrendPoint { at, value })
        };
        let before = earlier
            .iter()
            .filter_map(|kept| point(&kept.at, find(kept)));
        Self {
            light: measured.what.light(measured.value, first),
            first,
            last: earlier.last().and_then(find),
            trend: Trend::of(before.chain(point(at, measured.value))),
            measured,
        }
    }

    /// Whether it goes one way.
    pub fn drift(&self) -> Option<Drift> {
        self.trend.drift(self.measured.what.row().change)
    }
}

/// All figures of a check-up of now, judged.
pub fn checks(measured: Vec<Measured>, at: &str, earlier: &[Kept]) -> Vec<Check> {
    let measured = measured.into_iter();
    measured.map(|own| Check::of(own, at, earlier)).collect()
}

/// A joint that did not reach its ends, or was not measured: what is measured of such a hand is no birth record of it.
pub fn stopped_early(checks: &[Check]) -> Option<Dof> {
    let is_end = |what: Subject| matches!(what, Subject::OpenEnd | Subject::BentEnd);
    let ends = checks.iter().filter(|own| is_end(own.measured.what));
    let mut early = ends.filter(|own| matches!(own.light, Light::Act | Light::Unknown));
    early.find_map(|own| own.measured.of.joint())
}
