//! `params apply`: writes rows of a file to the hand and reads each back, with a backup before and a rollback after a failure.

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, WrongUsage, end, notify};
use crate::cli::params::args::ApplyArgs;
use crate::cli::params::patience::Patience;
use crate::cli::params::words::{self, or_dash, outcome_json, outcome_line};
use crate::cli::params::{place, reach};
use crate::params::changes::RowOutcome;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::tasks::apply::{Applied, Apply, Otherwise, apply};
use crate::tasks::{Risks, TaskError, TaskStep};
use anyhow::bail;
use serde_json::json;

/// Message if the user does not wait for the end.
pub(crate) const UNKNOWN: &str = "what the hand holds is unknown: check with 'handscope params dump'; 'handscope params backups' names what it held before";

/// Applies the file. Fails unless every chosen row is in effect.
pub(crate) async fn run(out: &mut Out, args: &ApplyArgs) -> anyhow::Result<()> {
    let (file, note) = words::load(&args.file)
        .map_err(|error| FailureKind::File.error(format!("{error}; nothing was written")))?;
    note.iter().for_each(|note| notify(note));
    let wanted = args.chosen(&file.params);
    if wanted.is_empty() {
        let what = if args.only.is_empty() {
            "no speeds or forces; name other rows with --only"
        } else {
            "none of the rows that --only names"
        };
        let path = args.file.display();
        bail!("{path} holds {what}; nothing was written");
    }
    let place = place::place_row(&args.common.hand, &wanted)?;
    let is_done = match place {
        Some((id, value)) => place::change(out, args, id, value).await,
        None => rows(out, args, &file.params, wanted).await,
    };
    match is_done.map_err(explained)? {
        Some(is_done) => end(is_done),
        None => nothing_to_write(out, args),
    }
}

/// Writes rows. Returns true if all are in effect; `None` if the hand held all of them already.
async fn rows(
    out: &mut Out,
    args: &ApplyArgs,
    whole: &Params,
    wanted: Params,
) -> anyhow::Result<Option<bool>> {
    let task = Apply {
        wanted,
        agreed: Risks::default(),
        backups: Some(args.common.backups()?),
        overshoot: reach::overshoot(&args.common.hand),
        otherwise: if args.partial {
            Otherwise::Stay
        } else {
            Otherwise::Undo
        },
    };
    let mut patience = Patience::begin()?;
    let written = patience.written();
    let link = patience
        .see_through(reach::open(&args.common.hand), "")
        .await??;
    let watch = |step| {
        if matches!(step, TaskStep::Writing(_)) {
            written.set(true);
        }
    };
    let mut user = reach::answers_of(args.yes);
    let apply = apply(&link, &task, &mut user, watch);
    let applied = patience.see_through(apply, UNKNOWN).await??;
    for row in applied.before.differences(whole) {
        if row.id.is_place() && task.wanted.get(row.id).is_none() {
            let (name, theirs, ours) = (row.id.name(), row.theirs, or_dash(row.ours));
            notify(&format!(
                "unchanged: {name} ({theirs} in the file, {ours} in the hand); --only {name} would change it",
            ));
        }
    }
    report_applied(out, args, &applied)
}

/// Converts an error of the task into one of the command.
fn explained(error: anyhow::Error) -> anyhow::Error {
    match error.downcast_ref() {
        Some(TaskError::Declined(risks)) => WrongUsage::error(format!(
            "{}; add --yes if you mean it; nothing was written",
            words::risks(risks).join("; ")
        )),
        _ => error,
    }
}

/// Reports that the hand already holds the values.
fn nothing_to_write(out: &mut Out, args: &ApplyArgs) -> anyhow::Result<()> {
    let hand = args.common.hand.to_string();
    out.result(
        args.common.json,
        &json!({ "hand": hand, "backup": null, "rows": [], "applied": true, "undone": null }),
        ["the hand already holds all of it; nothing was written"],
    )
}

fn report_applied(
    out: &mut Out,
    args: &ApplyArgs,
    applied: &Applied,
) -> anyhow::Result<Option<bool>> {
    let Some(backup) = &applied.backup else {
        return Ok(None);
    };
    let is_written = |row: &&RowOutcome| row.before != Some(row.wanted);
    let rows: Vec<&RowOutcome> = applied.rows.iter().filter(is_written).collect();
    let is_whole = applied.is_whole();
    let object = json!({
        "hand": args.common.hand.to_string(),
        "backup": backup,
        "rows": rows.iter().map(|row| outcome_json(row)).collect::<Vec<_>>(),
        "applied": is_whole,
        "undone": applied.undone,
    });
    let mut lines: Vec<String> = rows.iter().map(|row| outcome_line(row)).collect();
    lines.push(words::backup(backup));
    if is_whole {
        lines.push("not in flash yet: 'handscope params save' keeps it".into());
    }
    words::show(out, args.common.json, &object, &lines)?;
    if is_whole {
        if rows.iter().any(|row| row.id == ParamId::IpAddress) {
            notify(
                "ip_address takes effect after a save and a power cycle; until then the hand answers at its old address",
            );
        }
        return Ok(Some(true));
    }
    if let Some(why) = &applied.broken_off {
        notify(&format!("not everything was written: {why}"));
    }
    notify(match applied.undone {
        None => "not all rows were applied; those that were stay",
        Some(true) => "not all rows were applied; the hand holds what it held before",
        Some(false) => {
            "not all rows were applied, and it is not known whether the hand is back at its old values: check with 'handscope params diff', and apply the backup"
        }
    });
    Ok(Some(false))
}
