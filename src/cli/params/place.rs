//! `params apply` for an address row: the wire is closed and reopened for each address.

use crate::cli::out::{Out, notify};
use crate::cli::params::args::ApplyArgs;
use crate::cli::params::patience::Patience;
use crate::cli::params::reach::{self, LinkOpener};
use crate::cli::params::words;
use crate::params::place::{self, Moved, new_place};
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::tasks::place::{PlaceChange, PlaceReport, change_place};
use crate::tasks::{Question, Risks, TaskError, TaskStep, User as _, read};
use crate::transport::Endpoint;
use anyhow::bail;
use serde_json::json;
use std::path::Path;

/// Message if the user does not wait for the end.
const UNKNOWN: &str = "it is not known at which of both places the hand answers: look for it with 'handscope scan --all-ids'; nothing is in flash, so switched off and on it is where it was";

/// Changes the address, and reports where the hand answers. Returns true if it is there, or will be after a SAVE or a
/// power-up; `None` if the hand held the value already.
pub(crate) async fn change(
    out: &mut Out,
    args: &ApplyArgs,
    id: ParamId,
    wanted: Value,
) -> anyhow::Result<Option<bool>> {
    let files = args.common.backups()?;
    let old = args.common.hand.clone();
    let mut patience = Patience::begin()?;
    let written = patience.written();
    let link = patience.see_through(reach::open(&old), "").await??;
    let rows = read::rows(&link, |_, _| ());
    let rows = patience.see_through(rows, "").await?;
    drop(link);
    let before = rows.with(|_| true)?.get(id);
    let Some(before) = before.filter(|before| *before != wanted) else {
        return Ok(None);
    };
    let mut meant = Risks::default();
    meant.places.put(id, wanted);
    let mut user = reach::answers_of(args.yes);
    if !user.ask(Question::Apply(meant.clone())).await {
        return Err(TaskError::Declined(meant).into());
    }
    let new = new_place(&old, id, wanted).unwrap_or_else(|| old.clone());
    let change = PlaceChange {
        id,
        before,
        wanted,
        places: place::PlacePair { old, new },
        is_followed: true,
    };
    let mut reach = LinkOpener::default();
    let watch = |step| {
        if matches!(step, TaskStep::Writing(_)) {
            written.set(true);
        }
    };
    let changed = change_place(&mut reach, &change, &files, &mut user, watch);
    let report = patience.see_through(changed, UNKNOWN).await??;
    if let Some(why) = &report.not_noted {
        bail!(
            "the hand was changed, and its backups could not be moved along: they are in {}: {why}",
            files.folder().display()
        );
    }
    report_change(out, args, &change, &report)
}

fn report_change(
    out: &mut Out,
    args: &ApplyArgs,
    change: &PlaceChange,
    report: &PlaceReport,
) -> anyhow::Result<Option<bool>> {
    let (old, new) = (&change.places.old, &change.places.new);
    let Some(moved) = &report.moved else {
        bail!("the hand at {old} no longer answers; nothing was written");
    };
    let backup = &report.backup;
    let answers_at = match moved {
        Moved::There => Some(new.to_string()),
        Moved::Nowhere => None,
        _ => Some(old.to_string()),
    };
    let sentence = outcome(moved, change, backup);
    let is_done = matches!(moved, Moved::There | Moved::Waits);
    let row = json!({
        "name": change.id,
        "before": change.before,
        "wanted": change.wanted,
        "verdict": moved.name(),
    });
    let object = json!({
        "hand": old.to_string(),
        "backup": backup,
        "rows": [row],
        "applied": is_done,
        "answers_at": answers_at,
        "words": sentence,
    });
    if args.common.json || is_done {
        let lines = [sentence.clone(), words::backup(backup)];
        words::show(out, args.common.json, &object, &lines)?;
    }
    if !is_done {
        notify(&sentence);
    }
    Ok(Some(is_done))
}

fn outcome(moved: &Moved, change: &PlaceChange, backup: &Path) -> String {
    let (name, wanted) = (change.id.name(), change.wanted);
    let (old, new) = (&change.places.old, &change.places.new);
    match moved {
        Moved::There => format!(
            "{name} is {wanted}: the hand answers at {new} now. Not in flash: switched off and on it is at {old} again, unless 'handscope params save --yes --hand {new}' keeps it"
        ),
        Moved::Waits => format!(
            "{name} is {wanted} and does not act yet: the hand still answers at {old}. After a SAVE, or a SAVE and a power-up, look for it at {new}"
        ),
        Moved::Stayed => {
            format!("{name} was not changed: the hand answers at {old} and did not take it")
        }
        Moved::Refused { reason } => {
            format!("{name} was not changed: {reason}; the hand answers at {old}")
        }
        Moved::Occupied => {
            format!("{name} was not changed, nothing was written: another hand answers at {new}")
        }
        Moved::Nowhere => format!(
            "{name} was written, and the hand answers neither at {new} nor at {old}. Nothing is in flash: switch it off and on, and it is at {old} again; if it is not, look for it with 'handscope scan --all-ids'. What it held is in {}",
            backup.display()
        ),
    }
}

/// The address row of a file that affects this wire, if any.
pub(crate) fn place_row(
    hand: &Endpoint,
    chosen: &Params,
) -> anyhow::Result<Option<(ParamId, Value)>> {
    let is_bus = !matches!(hand, Endpoint::Tcp { .. });
    let moves = |(id, _): &(ParamId, Value)| matches!(id, ParamId::HandId | ParamId::ReduRatio);
    let Some((id, value)) = chosen.iter().find(|row| is_bus && moves(row)) else {
        return Ok(None);
    };
    let name = id.name();
    if chosen.iter().count() > 1 {
        bail!("{name} is changed alone: name no other row with --only; nothing was written");
    }
    if new_place(hand, id, value).is_none() {
        bail!(
            "{name} cannot be changed through {hand}: the hand could not be followed there; nothing was written"
        );
    }
    Ok(Some((id, value)))
}
