//! Rows, dangers and results as sentences, tables and JSON, shared by the parameter commands. Pure.

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, ReaderGone, notify};
use crate::hand::overshoot::MeasuredOn;
use crate::params::changes::{RowOutcome, RowVerdict};
use crate::params::danger::Danger;
use crate::params::file::{self, ParamsFile};
use crate::params::rows::{ParamId, Value};
use crate::record::Saved;
use crate::tasks::Risks;
use serde_json::{Value as Json, json};
use std::path::Path;

/// The value, or "-" if unknown.
pub(crate) fn or_dash(value: Option<Value>) -> String {
    value.map_or_else(|| "-".into(), |value| value.to_string())
}

/// A table of rows with two columns of values under these titles.
pub(crate) fn table(
    titles: [&str; 2],
    rows: impl IntoIterator<Item = (ParamId, [Option<Value>; 2])>,
) -> Vec<String> {
    let [one, two] = titles;
    let head = format!("{:<27}{one:>15} {two:>15}  unit manual", "");
    let line = |(id, values): (ParamId, [Option<Value>; 2])| {
        let [one, two] = values.map(or_dash);
        let (name, section) = (id.name(), id.register().section);
        format!("{name:<27}{one:>15} {two:>15}  {:<3} {section}", id.unit())
    };
    let lines = rows.into_iter().map(line);
    let all = std::iter::once(head).chain(lines);
    all.map(|line| line.trim_end().to_owned()).collect()
}

/// Loads a parameter file, with a note about unknown keys.
pub(crate) fn load(path: &Path) -> anyhow::Result<(ParamsFile, Option<String>)> {
    let file = file::load(path)
        .map_err(|error| FailureKind::File.error(format!("{}: {error}", path.display())))?;
    let unknown = file.unknown_keys();
    let note = format!("unknown keys: {}", unknown.join(", "));
    Ok((file, (!unknown.is_empty()).then_some(note)))
}

/// Prints a result, as one JSON object or as lines. If standard output is closed, the lines go to standard error: the values in
/// a hand after a write are always reported.
pub(crate) fn show(
    out: &mut Out,
    as_json: bool,
    object: &Json,
    lines: &[String],
) -> anyhow::Result<()> {
    let shown = out.result(as_json, object, lines);
    let shown = shown.and_then(|()| out.shown());
    if shown.is_err() {
        lines.iter().for_each(|line| notify(line));
    }
    match shown {
        Err(error) if !error.is::<ReaderGone>() => Err(error),
        _ => Ok(()),
    }
}

pub(crate) fn backup(path: &Path) -> String {
    format!("backup: {}", path.display())
}

/// Warning about power-up defaults that close hard.
fn danger(danger: &Danger) -> String {
    let joint = danger.dof.name();
    let (speed, force) = (danger.speed, danger.force_g);
    let strong = if danger.is_above_rated() {
        ", above the rated grip of 2000 g"
    } else {
        ""
    };
    let measured = match &danger.expected.on {
        MeasuredOn::AnotherHand => {
            "on a rigid block, such a finger of another hand was measured to press".into()
        }
        MeasuredOn::ThisHand { closes, last } => {
            format!("this finger was measured in {closes} closes, the last on {last}, to press")
        }
    };
    format!(
        "{joint} would start with speed {speed} and a force threshold of {force} g{strong}; {measured} {:.0} g beyond its threshold",
        danger.expected.over_g
    )
}

/// Changes that require confirmation: defaults that close harder than before, and address rows.
pub(crate) fn risks(risks: &Risks) -> Vec<String> {
    let dangers = risks.dangers.iter().map(danger);
    let places = risks.places.iter().map(|(id, value)| {
        let name = id.name();
        format!("{name} becomes {value}: the hand may be found elsewhere")
    });
    dangers.chain(places).collect()
}

/// Prints the risks as warnings.
pub(crate) fn warn(meant: &Risks) {
    for reason in risks(meant) {
        notify(&format!("warning: {reason}"));
    }
}

/// Outcome of one row.
pub(crate) fn outcome_json(end: &RowOutcome) -> Json {
    let reason = match &end.verdict {
        RowVerdict::Refused { reason } => Some(reason.to_string()),
        RowVerdict::Unverified(why) => Some(why.to_string()),
        RowVerdict::NotSent(why) => Some(why.to_string()),
        _ => None,
    };
    json!({
        "name": end.id,
        "before": end.before,
        "wanted": end.wanted,
        "holds": end.holds,
        "verdict": end.verdict.name(),
        "reason": reason,
    })
}

/// The same as a line.
pub(crate) fn outcome_line(end: &RowOutcome) -> String {
    format!(
        "{:<27}{:>15} -> {:<15} holds {:<15} {}",
        end.id.name(),
        or_dash(end.before),
        end.wanted.to_string(),
        or_dash(end.holds),
        verdict(end)
    )
}

fn verdict(end: &RowOutcome) -> String {
    match &end.verdict {
        RowVerdict::Applied => "applied".into(),
        RowVerdict::Refused { reason } => format!("refused: {reason}"),
        RowVerdict::Dropped => {
            "not applied: the hand did not object, but kept its old value".into()
        }
        RowVerdict::Altered => "not applied: the hand took another value".into(),
        RowVerdict::PutBack => "put back: not all rows could be applied".into(),
        RowVerdict::Unverified(why) => format!("not known: {why}"),
        RowVerdict::NotSent(why) => format!("not written: {why}"),
    }
}

/// The result of a SAVE, in one sentence.
pub(crate) fn saved(saved: &Saved) -> String {
    match saved {
        Saved::Confirmed => "saved: the hand says that its parameters are in flash".into(),
        Saved::ReadBack => "saved as far as this wire tells: the hand acknowledged it and holds the same parameters; only the next power-up shows what is in flash".into(),
        Saved::Failed { code } => format!(
            "not saved: the hand says that writing its flash failed (code {code}); what was in flash before should still be there"
        ),
        Saved::Unknown { why } => format!(
            "it is not known whether it was saved: {why}; switch the hand off and on, then compare with 'handscope params diff'"
        ),
        Saved::Refused { reason } => format!("not saved: {reason}"),
        Saved::NotSent(why) => format!("not saved, nothing was written: {why}"),
    }
}
