//! How often the told state of a grip is wrong, over 2 000 grasps of random bodies and objects in virtual time.

use crate::grip_table::{GripTable, grasps};
use crate::report::{Aim, Failure, Report};

/// Random bodies, with 20 grasps each.
const BODIES: u64 = 100;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let table = grasps(0..BODIES);
    let percent = |part: f64| part * 100.0;
    let of = |part: u64, all: u64| 100.0 * part as f64 / all.max(1) as f64;
    let wrong = |table| percent(GripTable::wrong(table));
    report.row(
        "grasps judged",
        table.count as f64,
        "",
        Aim::AtLeast(2000.0),
    )?;
    report.row(
        "grip of a finger told wrong in steady states",
        wrong(&table.fingers),
        "%",
        Aim::AtMost(2.0),
    )?;
    report.row(
        "grip of the hand told wrong in steady states",
        wrong(&table.grasps),
        "%",
        Aim::AtMost(2.0),
    )?;
    report.row(
        "losses told within 150 ms",
        percent(table.losses_in_time()),
        "%",
        Aim::AtLeast(98.0),
    )?;
    report.row(
        "slips told before the object is lost",
        of(table.slides_told, table.slides),
        "%",
        Aim::AtLeast(90.0),
    )?;
    report.row(
        "grasps without a slip in which one was told",
        of(table.calm_slips, table.calm),
        "%",
        Aim::AtMost(2.0),
    )?;
    report.text(&GripTable::text(&table.fingers))?;
    report.text(&GripTable::text(&table.grasps))
}
