//! `registers`: the register map as text and as JSON, from the same table.

use crate::cli::out::Out;
use crate::hand::register::{Origin, REGISTERS, Register};
use serde::Serialize;
use serde_json::Value;

/// A register as scripts see it, with derived fields.
#[derive(Serialize)]
struct RegisterRow {
    #[serde(flatten)]
    register: Register,
    count: u16,
    in_manual: bool,
}

impl From<&Register> for RegisterRow {
    fn from(register: &Register) -> Self {
        Self {
            register: *register,
            count: register.count(),
            in_manual: register.origin == Origin::Manual,
        }
    }
}

/// Title, key of the JSON object, and padding of a cell.
type RegisterColumn = (&'static str, &'static str, fn(&str) -> String);

const COLUMNS: [RegisterColumn; 11] = [
    ("name", "name", left::<20>),
    ("address", "address", right::<7>),
    ("bytes", "bytes", right::<5>),
    ("element", "element", |cell| format!(" {cell:<7}")),
    ("rw", "access", left::<3>),
    ("range", "range", left::<13>),
    ("default", "default", right::<7>),
    ("unit", "unit", left::<4>),
    ("kept", "kept", left::<8>),
    ("manual", "section", left::<7>),
    ("meaning", "meaning", str::to_owned),
];

fn left<const WIDTH: usize>(cell: &str) -> String {
    format!("{cell:<WIDTH$}")
}

fn right<const WIDTH: usize>(cell: &str) -> String {
    format!("{cell:>WIDTH$}")
}

pub(crate) fn run(out: &mut Out, as_json: bool) -> anyhow::Result<()> {
    let rows: Value = serde_json::to_value(REGISTERS.each_ref().map(RegisterRow::from).as_slice())?;
    if as_json {
        return out.object(&rows);
    }
    out.line(&COLUMNS.map(|(title, _, fill)| fill(title)).join(" "))?;
    for row in rows.as_array().into_iter().flatten() {
        out.line(
            &COLUMNS
                .map(|(_, key, fill)| fill(&cell(row, key)))
                .join(" "),
        )?;
    }
    out.line("")?;
    out.line(
        "* not in the manual's register table: known from other programs for this family of hands",
    )
}

fn cell(row: &Value, key: &str) -> String {
    let also = row.get("also").filter(|also| !also.is_null());
    match (key, row.get(key)) {
        (_, None | Some(Value::Null)) => "-".to_owned(),
        ("name", Some(Value::String(name))) if row.get("in_manual") != Some(&true.into()) => {
            format!("{name}*")
        }
        ("range", Some(range)) => {
            let also = also.map(|also| format!("{also}, ")).unwrap_or_default();
            let end = |at: usize| range.get(at).map(Value::to_string).unwrap_or_default();
            format!("{also}{}..{}", end(0), end(1))
        }
        (_, Some(Value::String(word))) => word.clone(),
        (_, Some(other)) => other.to_string(),
    }
}
