//! `registers`: the map as text for people and JSON for scripts, made from the one table.

use crate::cli::out::Out;
use crate::hand::register::{Access, Element, Origin, Persistence, REGISTERS, Register};
use serde_json::{Value, json};

/// Prints the register map.
pub(crate) fn run(out: &mut Out, as_json: bool) -> anyhow::Result<()> {
    if as_json {
        let rows: Vec<Value> = REGISTERS.iter().map(row_json).collect();
        return out.line(&serde_json::to_string_pretty(&rows)?);
    }
    out.line(&format!(
        "{:<20} {:>7} {:>5}  {:<7} {:<3} {:<13} {:>7} {:<4} {:<8} {:<7} {}",
        "name",
        "address",
        "bytes",
        "element",
        "rw",
        "range",
        "default",
        "unit",
        "kept",
        "manual",
        "meaning"
    ))?;
    for row in &REGISTERS {
        out.line(&row_text(row))?;
    }
    out.line("\n* not in the manual's register table: known from other programs for this family of hands")
}

fn row_text(row: &Register) -> String {
    let range = row.range.map_or_else(
        || "-".into(),
        |(min, max)| {
            let also = row
                .also
                .map_or_else(String::new, |also| format!("{also}, "));
            format!("{also}{min}..{max}")
        },
    );
    let mark = if row.origin == Origin::Field { "*" } else { "" };
    let default = row
        .default
        .map_or_else(|| "-".into(), |default| default.to_string());
    format!(
        "{:<20} {:>7} {:>5}  {:<7} {:<3} {:<13} {:>7} {:<4} {:<8} {:<7} {}",
        format!("{}{mark}", row.name),
        row.address,
        row.len,
        element(row.element),
        access(row.access),
        range,
        default,
        row.unit,
        kept(row.persistence),
        row.section,
        row.meaning
    )
}

fn row_json(row: &Register) -> Value {
    json!({
        "name": row.name,
        "address": row.address,
        "bytes": row.len,
        "element": element(row.element),
        "count": row.count(),
        "access": access(row.access),
        "range": row.range.map(|(min, max)| [min, max]),
        "also": row.also,
        "default": row.default,
        "unit": row.unit,
        "kept": kept(row.persistence),
        "section": row.section,
        "in_manual": row.origin == Origin::Manual,
        "meaning": row.meaning,
    })
}

const fn element(element: Element) -> &'static str {
    match element {
        Element::Byte => "byte",
        Element::Short => "short",
        Element::Tactile => "tactile",
    }
}

const fn access(access: Access) -> &'static str {
    match access {
        Access::Read => "r",
        Access::ReadWrite => "rw",
    }
}

const fn kept(persistence: Persistence) -> &'static str {
    match persistence {
        Persistence::Volatile => "no",
        Persistence::Saved => "by SAVE",
        Persistence::Live => "live",
    }
}
