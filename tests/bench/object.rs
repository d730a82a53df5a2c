//! What 200 holds say about random objects, in virtual time: size, stiffness, weight, and whether they yield.

use crate::object_table::objects;
use crate::report::{Aim, Failure, Report};

/// Random objects, on 40 random bodies.
const OBJECTS: u64 = 200;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let table = objects(0..OBJECTS);
    let percent = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
    let rows = [
        (
            "size within 2 mm",
            100.0 * table.size_right(),
            Aim::AtLeast(95.0),
        ),
        (
            "size inside its bound",
            100.0 - percent(table.size_outside, table.size_mm.len()),
            Aim::AtLeast(95.0),
        ),
        (
            "class of the stiffness",
            100.0 * table.class_share(),
            Aim::AtLeast(95.0),
        ),
        (
            "weight within 20 %",
            100.0 * table.weight_right(),
            Aim::AtLeast(100.0),
        ),
        (
            "weight told",
            percent(table.weight.len(), table.held),
            Aim::None,
        ),
        (
            "yielding right",
            percent(table.yield_right, table.yield_right + table.yield_wrong),
            Aim::None,
        ),
    ];
    for (what, value, aim) in rows {
        report.row(&format!("object: {what}"), value, "%", aim)?;
    }
    report.text(&table.line())
}
