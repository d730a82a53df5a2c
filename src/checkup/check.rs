//! A figure beside what it should be, and what it was.

use crate::checkup::measure::Measured;
use crate::checkup::subject::Light;

/// One figure, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    pub measured: Measured,
    /// What it was at the first check-up of this hand, and at the last before this one.
    pub first: Option<f64>,
    pub last: Option<f64>,
    pub light: Light,
}

impl Check {
    /// Of a figure, and those of the first and the last check-up.
    pub fn of(measured: Measured, first: &[Measured], last: &[Measured]) -> Self {
        let same = |own: &&Measured| (own.what, own.of) == (measured.what, measured.of);
        let find = |all: &[Measured]| all.iter().find(same).and_then(|own| own.value);
        let (first, last) = (find(first), find(last));
        Self {
            light: measured.what.light(measured.value, first),
            measured,
            first,
            last,
        }
    }
}
