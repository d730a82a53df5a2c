//! How a hold keeps 2 000 random objects between two forces, in virtual time: what it drops, breaks and presses.

use crate::hold_table::{HoldTable, Outcome, at_share, holds, mean};
use crate::report::{Aim, Failure, Report};

/// Random objects, on 40 random bodies.
const HOLDS: u64 = 2000;
/// How far a drive at the speed of the close may run past its threshold, g.
const OVERSHOOT_G: f64 = 64.0;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let table = holds(0..HOLDS);
    let percent = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
    let possible = table.count(|own| own.plan.is_possible());
    let peaks = table.count(|own| own.over_g > OVERSHOOT_G);
    let rows = [
        ("objects held", HOLDS as f64, "", Aim::AtLeast(2000.0)),
        (
            "dropped although at most would have held",
            percent(table.count(Outcome::is_missed), possible),
            "%",
            Aim::AtMost(2.0),
        ),
        (
            "fragile objects broken",
            table.count(|own| own.is_broken) as f64,
            "",
            Aim::AtMost(0.0),
        ),
        (
            "peaks over at most + 64 g, the overshoot of speed 25",
            percent(peaks, table.outcomes.len()),
            "%",
            Aim::AtMost(1.0),
        ),
        (
            "mean force relative to the least that would have held",
            mean(&table.ratios()),
            "",
            Aim::AtMost(1.3),
        ),
        (
            "reversals a minute without a disturbance",
            table.reversals_per_min(),
            "1/min",
            Aim::AtMost(0.0),
        ),
    ];
    for (what, value, unit, aim) in rows {
        report.row(&format!("hold: {what}"), value, unit, aim)?;
    }
    delays(report, &table)?;
    report.text(&table.line())
}

/// Our own delay: from the reading to the frame.
fn delays(report: &mut Report, table: &HoldTable) -> Result<(), Failure> {
    let delays_ms = table.delays_ms();
    let rows = [(0.5, "median"), (0.9, "90 of 100")];
    for (share, name) in rows {
        report.row(
            &format!("hold: reading that shows a slide to tighter frame, {name}"),
            at_share(&delays_ms, share),
            "ms",
            Aim::None,
        )?;
    }
    let (some, none) = (delays_ms.len(), table.unanswered());
    report.row(
        "hold: slides with room that no frame answered",
        100.0 * none as f64 / (some + none).max(1) as f64,
        "%",
        Aim::None,
    )
}
