//! `registers`: the register map as text and as JSON, from the one table.

use crate::cli::out::Out;
use crate::hand::register::{Origin, REGISTERS, Register};
use serde::Serialize;
use serde_json::Value;

/// A register as scripts see it, with what follows from it.
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

/// Prints the register map.
pub(crate) fn run(out: &mut Out, as_json: bool) -> anyhow::Result<()> {
    let rows: Value = serde_json::to_value(REGISTERS.each_ref().map(RegisterRow::from).as_slice())?;
    if as_json {
        return out.line(&serde_json::to_string_pretty(&rows)?);
    }
    out.line(&line([
        "name", "address", "bytes", "element", "rw", "range", "default", "unit", "kept", "manual",
        "meaning",
    ]))?;
    for row in rows.as_array().into_iter().flatten() {
        out.line(&text(row))?;
    }
    out.line("\n* not in the manual's register table: known from other programs for this family of hands")
}

fn text(row: &Value) -> String {
    let word = |key: &str| match row.get(key) {
        None | Some(Value::Null) => "-".to_owned(),
        Some(Value::String(word)) => word.clone(),
        Some(other) => other.to_string(),
    };
    let mark = if word("in_manual") == "true" { "" } else { "*" };
    let range = match row
        .get("range")
        .and_then(Value::as_array)
        .map(Vec::as_slice)
    {
        Some([min, max]) if word("also") == "-" => format!("{min}..{max}"),
        Some([min, max]) => format!("{}, {min}..{max}", word("also")),
        _ => "-".into(),
    };
    line([
        &(word("name") + mark),
        &word("address"),
        &word("bytes"),
        &word("element"),
        &word("access"),
        &range,
        &word("default"),
        &word("unit"),
        &word("kept"),
        &word("section"),
        &word("meaning"),
    ])
}

/// The columns of the table.
fn line(cells: [&str; 11]) -> String {
    let [
        name,
        address,
        bytes,
        element,
        access,
        range,
        default,
        unit,
        kept,
        section,
        meaning,
    ] = cells;
    format!(
        "{name:<20} {address:>7} {bytes:>5}  {element:<7} {access:<3} {range:<13} {default:>7} {unit:<4} {kept:<8} {section:<7} {meaning}"
    )
}
