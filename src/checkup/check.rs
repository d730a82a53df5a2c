//! A figure with its judgement and its history.

use crate::checkup::kept::StoredCheckup;
use crate::checkup::measure::Measured;
use crate::checkup::subject::{Grade, Subject};
use crate::checkup::trend::{Drift, Trend, TrendPoint};
use crate::hand::Dof;

/// One figure, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    pub measured: Measured,
    /// The value at the first check-up of this hand, and at the last one before this.
    pub first: Option<f64>,
    pub last: Option<f64>,
    pub grade: Grade,
    /// Over the most recent check-ups; this one is the last point.
    pub trend: Trend,
}

impl Check {
    /// Judges a new figure against the earlier check-ups of this hand, oldest first.
    pub fn of(measured: Measured, at: &str, earlier: &[StoredCheckup]) -> Self {
        let same = |own: &&Measured| (own.what, own.of) == (measured.what, measured.of);
        let find = |kept: &StoredCheckup| kept.figures.iter().find(same).and_then(|own| own.value);
        let first = earlier.first().and_then(find);
        let point = |at: &str, value: Option<f64>| {
            let at = at.to_owned();
            value.map(|value| TrendPoint { at, value })
        };
        let before = earlier
            .iter()
            .filter_map(|kept| point(&kept.at, find(kept)));
        Self {
            grade: measured.what.grade(measured.value, first),
            first,
            last: earlier.last().and_then(find),
            trend: Trend::of(before.chain(point(at, measured.value))),
            measured,
        }
    }

    /// The drift of this figure; `None` while it shows no trend.
    pub fn drift(&self) -> Option<Drift> {
        self.trend.drift(self.measured.what.row().change)
    }
}

/// Judges all figures of a new check-up.
pub fn checks(measured: Vec<Measured>, at: &str, earlier: &[StoredCheckup]) -> Vec<Check> {
    let measured = measured.into_iter();
    measured.map(|own| Check::of(own, at, earlier)).collect()
}

/// The first joint that did not reach its ends, or was not measured. The check-up of such a hand is not stored as its birth record.
pub fn stopped_early(checks: &[Check]) -> Option<Dof> {
    let is_end = |what: Subject| matches!(what, Subject::OpenEnd | Subject::BentEnd);
    let ends = checks.iter().filter(|own| is_end(own.measured.what));
    let mut early = ends.filter(|own| matches!(own.grade, Grade::Act | Grade::Unknown));
    early.find_map(|own| own.measured.of.joint())
}
