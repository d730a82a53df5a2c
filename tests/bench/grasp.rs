//! Grasps saved on one hand and confirmed by 20 others with known newtons, in virtual time: how many claims are false.

use crate::grasp_table::{OTHERS, grasps};
use crate::report::{Aim, Failure, Report};

/// Grasps, each made on a body of its own.
const GRASPS: usize = 10;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let table = grasps(GRASPS, OTHERS);
    let percent = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
    let (trusted, same) = (table.trusted(), table.count(|own| own.is_same_object));
    let rows = [
        (
            "false claims, of those that are trusted",
            percent(table.false_claims(), trusted),
            Aim::AtMost(5.0),
        ),
        (
            "trusted with the same object",
            percent(
                table.count(|own| own.is_same_object && own.doubt.is_none()),
                same,
            ),
            Aim::None,
        ),
        (
            "trusted with an object that differs",
            percent(
                table.count(|own| !own.is_same_object && own.doubt.is_none()),
                table.used.len() - same,
            ),
            Aim::None,
        ),
    ];
    for (what, value, aim) in rows {
        report.row(&format!("grasp: {what}"), value, "%", aim)?;
    }
    let false_claims = table.used.iter().filter(|own| own.is_false_claim());
    for own in false_claims {
        report.text(&own.told)?;
    }
    report.text(&table.line())
}
