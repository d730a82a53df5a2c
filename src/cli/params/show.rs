//! Rows of parameters for people and for JSON. Pure.

use crate::app::params::plan::{RowEnd, RowVerdict};
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::Params;
use crate::cli::params::words::{or_dash, verdict};
use serde_json::{Map, Value as Json, json};

/// A value for JSON; null if it is not known.
pub(crate) fn json_of(value: Option<Value>) -> Json {
    match value {
        None => Json::Null,
        Some(Value::Number(number)) => number.into(),
        Some(Value::Address(address)) => address.to_string().into(),
    }
}

/// All rows by name.
pub(crate) fn params_json(params: &Params) -> Json {
    let rows = ParamId::all().into_iter();
    let rows: Map<String, Json> = rows
        .map(|id| (id.name(), json_of(params.get(id))))
        .collect();
    Json::Object(rows)
}

/// One line of a table: name, columns, unit, section.
pub(crate) fn line(id: ParamId, columns: &[String]) -> String {
    let columns: Vec<String> = columns.iter().map(|text| format!("{text:>15}")).collect();
    let row = id.register();
    let line = format!(
        "{:<27}{}  {:<3} {}",
        id.name(),
        columns.join(" "),
        id.unit(),
        row.section
    );
    line.trim_end().to_owned()
}

/// The head of such a table.
pub(crate) fn head(columns: &[&str]) -> String {
    let columns: Vec<String> = columns.iter().map(|text| format!("{text:>15}")).collect();
    format!("{:<27}{}  unit manual", "", columns.join(" "))
}

/// One row that was to be written.
pub(crate) fn end_json(end: &RowEnd) -> Json {
    let reason = match &end.verdict {
        RowVerdict::Refused { reason } => Some(reason.clone()),
        RowVerdict::Unverified(why) => Some(why.to_string()),
        RowVerdict::NotSent(why) => Some(why.to_string()),
        _ => None,
    };
    json!({
        "name": end.id.name(),
        "before": json_of(end.before),
        "wanted": json_of(Some(end.wanted)),
        "holds": json_of(end.holds),
        "verdict": end.verdict.name(),
        "reason": reason,
    })
}

/// The same as a line.
pub(crate) fn end_line(end: &RowEnd) -> String {
    format!(
        "{:<27}{:>15} -> {:<15} holds {:<15} {}",
        end.id.name(),
        or_dash(end.before),
        end.wanted.to_string(),
        or_dash(end.holds),
        verdict(end)
    )
}
