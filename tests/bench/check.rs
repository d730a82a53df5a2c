//! Check-ups of bodies that they do not know, in virtual time: false alarms on healthy ones, and how often each kind of wear is
//! found.

use crate::report::{Aim, Failure, Report};
use crate::worn::{WEARS, checked, finds, told};
use handscope::sim::body_params::random::random;

/// Healthy bodies, and runs of each wear; the tests have looked at the first of both.
const HEALTHY: u64 = 200;
const RUNS: u64 = 100;
const FROM: u64 = 1000;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let alarms = (FROM..FROM + HEALTHY).map(|seed| told(&checked(random(seed), seed, &[])).len());
    let alarmed = share(alarms.map(|wrong| wrong > 0));
    report.row(
        "healthy bodies with a false alarm",
        alarmed,
        "%",
        Aim::AtMost(2.0),
    )?;
    for wear in WEARS {
        let found = share((FROM..FROM + RUNS).map(|seed| finds(wear, seed)));
        report.row(
            &format!("  found: {}", wear.0),
            found,
            "%",
            Aim::AtLeast(95.0),
        )?;
    }
    Ok(())
}

/// Percent of them that are so.
fn share(all: impl Iterator<Item = bool>) -> f64 {
    let (mut so, mut count) = (0.0, 0.0);
    for is_so in all {
        so += f64::from(u8::from(is_so));
        count += 1.0;
    }
    100.0 * so / count
}
