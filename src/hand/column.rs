//! Column names and text cells of measurement tables, the same in every file. Stable.

use crate::hand::dof::{Dof, Finger};
use crate::hand::quantity::{Quantity, QuantityRow, Touch};

/// Column of a joint's quantity: quantity, joint, unit.
pub fn joint_column(quantity: Quantity, dof: Dof) -> String {
    named(quantity.row(), dof.name())
}

/// Column of a joint's force in newtons.
pub fn newton_column(dof: Dof) -> String {
    format!("force_{}_N", dof.name())
}

/// Column of a fingertip's quantity.
pub fn tip_column(touch: Touch, finger: Finger) -> String {
    named(touch.row(), finger.name())
}

/// Column of one of a fingertip's eight channels, counted from 0.
pub fn channel_column(channel: u8, finger: Finger) -> String {
    format!("channel_{}_{}", channel + 1, finger.name())
}

/// Columns of the grip: the grasp, then each finger.
pub fn grip_columns() -> [String; 6] {
    let [little, ring, middle, index, thumb] =
        Finger::ALL.map(|finger| format!("grip_{}", finger.name()));
    ["grip".to_owned(), little, ring, middle, index, thumb]
}

fn named(row: &QuantityRow, part: &str) -> String {
    let unit = if row.unit.is_empty() { "" } else { "_" };
    format!("{}_{part}{unit}{}", row.name, row.unit)
}

/// Formats a cell of free text for comma-separated values. Text that a spreadsheet would read as a formula is escaped.
pub fn text_cell(words: &str) -> String {
    let formula = words.starts_with(['=', '+', '-', '@']);
    let lead = if formula { "\'" } else { "" };
    if formula || words.contains([',', '"', '\n', '\r']) {
        return format!("\"{lead}{}\"", words.replace('"', "\"\""));
    }
    words.to_owned()
}
