//! Names of columns in tables of measurements, and cells of text in them: the same in every file. Stable.

use crate::hand::dof::{Dof, Finger};
use crate::hand::quantity::{Quantity, QuantityRow, Touch};

/// The column of a joint's quantity: what, of which joint, unit.
pub fn joint_column(quantity: Quantity, dof: Dof) -> String {
    named(quantity.row(), dof.name())
}

/// The column of a fingertip's quantity.
pub fn tip_column(touch: Touch, finger: Finger) -> String {
    named(touch.row(), finger.name())
}

/// The column of one of a fingertip's eight channels, from 0.
pub fn channel_column(channel: u8, finger: Finger) -> String {
    format!("channel_{}_{}", channel + 1, finger.name())
}

/// The columns of the grip: of the grasp, then of each finger.
pub fn grip_columns() -> [String; 6] {
    let [little, ring, middle, index, thumb] =
        Finger::ALL.map(|finger| format!("grip_{}", finger.name()));
    ["grip".to_owned(), little, ring, middle, index, thumb]
}

fn named(row: &QuantityRow, part: &str) -> String {
    let unit = if row.unit.is_empty() { "" } else { "_" };
    format!("{}_{part}{unit}{}", row.name, row.unit)
}

/// A cell of free text in comma-separated values. One that a spreadsheet would take for a formula is made a text.
pub fn text_cell(words: &str) -> String {
    let formula = words.starts_with(['=', '+', '-', '@']);
    let lead = if formula { "\'" } else { "" };
    if formula || words.contains([',', '"', '\n', '\r']) {
        return format!("\"{lead}{}\"", words.replace('"', "\"\""));
    }
    words.to_owned()
}
