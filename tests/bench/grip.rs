//! How often the told state of a grip is wrong, in virtual time: over 2 000 grasps of random bodies and objects of the simulated hand, and
//! over as many that know nothing of that hand.

use crate::grip_model;
use crate::grip_table::{GripTable, grasps};
use crate::report::{Aim, Failure, Report};

/// Random bodies, with 20 grasps each.
const BODIES: u64 = 100;
/// Modelled hands that the thresholds were not adjusted with, 16 grasps each.
const HANDS: std::ops::Range<u64> = 70_000..70_125;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let modelled = grip_model::grasps(HANDS);
    let turns = of(modelled.turn_slips, modelled.turns);
    let both = [
        ("simulated hand", grasps(0..BODIES)),
        ("modelled hands", modelled),
    ];
    for (name, table) in &both {
        rows(report, name, table)?;
    }
    report.row(
        "modelled hands: wrist turns in which a slip was told",
        turns,
        "%",
        Aim::AtMost(0.0),
    )?;
    for (name, table) in &both {
        report.text(&format!("{name}: {}", table.line()))?;
        report.text(&GripTable::text(&table.fingers))?;
        report.text(&GripTable::text(&table.grasps))?;
    }
    Ok(())
}

fn of(part: u64, all: u64) -> f64 {
    100.0 * part as f64 / all.max(1) as f64
}

fn rows(report: &mut Report, name: &str, table: &GripTable) -> Result<(), Failure> {
    let percent = |part: f64| part * 100.0;
    let (fingers, grasps) = (&table.fingers, &table.grasps);
    let rows = [
        (
            "grasps judged",
            table.count as f64,
            "",
            Aim::AtLeast(2000.0),
        ),
        (
            "grip of a finger told wrong in steady states",
            percent(GripTable::wrong(fingers)),
            "%",
            Aim::AtMost(1.0),
        ),
        (
            "grip of the hand told wrong in steady states",
            percent(GripTable::wrong(grasps)),
            "%",
            Aim::AtMost(1.0),
        ),
        (
            "grip of a finger told unknown in steady states",
            percent(GripTable::unknown(fingers)),
            "%",
            Aim::AtMost(2.0),
        ),
        (
            "losses told within 150 ms",
            percent(table.losses_in_time()),
            "%",
            Aim::AtLeast(99.0),
        ),
        (
            "slips told before the object is lost",
            of(table.slides_told, table.slides),
            "%",
            Aim::AtLeast(90.0),
        ),
        (
            "grasps without a slip in which one was told",
            of(table.calm_slips, table.calm),
            "%",
            Aim::AtMost(2.0),
        ),
    ];
    for (what, value, unit, aim) in rows {
        report.row(&format!("{name}: {what}"), value, unit, aim)?;
    }
    Ok(())
}
