//! `params apply`: rows of a file into the hand, each read back, with a backup before and the way back after a failure.

use crate::app::calendar::since_1970;
use crate::app::params::danger::worse;
use crate::app::params::file;
use crate::app::params::plan::{self, Plan, RowEnd, RowVerdict};
use crate::app::params::table::ParamId;
use crate::app::params::values::Params;
use crate::cli::out::{Out, Told, WrongUsage, say};
use crate::cli::params::args::ApplyArgs;
use crate::cli::params::relocate::{self, Change};
use crate::cli::params::show;
use crate::cli::params::talk::Talk;
use crate::cli::params::words::{self, or_dash, record};
use crate::cli::session;
use crate::link::{Verdict, Written};
use anyhow::{Context as _, anyhow};
use serde_json::{Value, json};

/// Applies. Fails unless every chosen row is in force.
pub(crate) fn run(out: &mut Out, args: &ApplyArgs) -> anyhow::Result<()> {
    let path = &args.file;
    let file = file::load(path)
        .map_err(|error| anyhow!("{}: {error}; nothing was written", path.display()))?;
    let unknown = file.unknown_keys();
    if !unknown.is_empty() {
        say(&format!("keys that are not known: {}", unknown.join(", ")));
    }
    let named = |id| args.only.iter().any(|rows| rows.0.contains(&id));
    let wanted = file.params.only(|id| match args.only.is_empty() {
        true => !id.is_place(),
        false => named(id),
    });
    if wanted.is_empty() {
        let what = match args.only.is_empty() {
            true => "speeds or forces; name other rows with --only",
            false => "of the rows that --only names",
        };
        return Err(anyhow!(
            "{} holds none {what}; nothing was written",
            path.display()
        ));
    }
    let change = relocate::wanted_change(&args.common.hand, &wanted)?;
    session::runtime()?.block_on(async {
        match change {
            Some(change) => elsewhere(out, args, &wanted, &change).await,
            None => apply(out, args, &file.params, &wanted).await,
        }
    })
}

/// A row by which the hand is found on this wire.
async fn elsewhere(
    out: &mut Out,
    args: &ApplyArgs,
    wanted: &Params,
    change: &Change,
) -> anyhow::Result<()> {
    let record = record(&args.common)?;
    let mut talk = Talk::open(&args.common.hand).await?;
    let before = talk.read_whole().await?;
    drop(talk);
    let plan = plan::plan(wanted, &before);
    consent(&plan, &before, args)?;
    if plan.settings.is_empty() {
        return nothing_to_write(out, args);
    }
    relocate::run(out, args, &record, &before, change).await
}

fn nothing_to_write(out: &mut Out, args: &ApplyArgs) -> anyhow::Result<()> {
    if args.common.json {
        let hand = args.common.hand.to_string();
        let object =
            json!({ "hand": hand, "backup": null, "rows": [], "applied": true, "undone": null });
        return out.line(&object.to_string());
    }
    out.line("the hand holds all of it already; nothing was written")
}

async fn apply(
    out: &mut Out,
    args: &ApplyArgs,
    whole: &Params,
    wanted: &Params,
) -> anyhow::Result<()> {
    let common = &args.common;
    let record = record(common)?;
    let mut talk = Talk::open(&common.hand).await?;
    let before = talk.read_whole().await?;
    let plan = plan::plan(wanted, &before);
    consent(&plan, &before, args)?;
    for row in before.differences(whole) {
        if row.id.is_place() && wanted.get(row.id).is_none() {
            say(&format!(
                "left alone: {} ({} in the file, {} in the hand); --only {} would change it",
                row.id.name(),
                row.theirs,
                or_dash(row.ours),
                row.id.name()
            ));
        }
    }
    if plan.settings.is_empty() {
        return nothing_to_write(out, args);
    }
    let backup = record
        .back_up(&before, "before apply", since_1970())
        .context("cannot make a backup, nothing was written to the hand")?;
    let ends = write(&mut talk, &plan, &before).await?;
    let applied = ends.iter().all(|end| end.verdict == RowVerdict::Applied);
    let undone = match applied || args.partial {
        true => None,
        false => Some(undo(&mut talk, &ends, &before).await),
    };
    if common.json {
        let rows: Vec<Value> = ends.iter().map(show::end_json).collect();
        let object = json!({
            "hand": common.hand.to_string(),
            "backup": backup,
            "rows": rows,
            "applied": applied,
            "undone": undone,
        });
        out.line(&object.to_string())?;
    } else {
        for end in &ends {
            out.line(&show::end_line(end))?;
        }
        out.line(&format!("backup: {}", backup.display()))?;
    }
    if applied {
        if plan.rows.get(ParamId::IpAddress).is_some() {
            say(
                "ip_address acts once it was saved and the hand was switched off and on; until then the hand answers where it did",
            );
        }
        if !common.json {
            out.line("not in flash yet: 'handscope params save' keeps it")?;
        }
        return Ok(());
    }
    say(match undone {
        None => "not all rows were applied; those that were stay",
        Some(true) => "not all rows were applied; the hand holds again what it held before",
        Some(false) => {
            "not all rows were applied, and it is not known whether the hand holds again what it held before: read it with 'handscope params diff', and apply the backup"
        }
    });
    Err(Told.into())
}

/// What must be meant: rows that say where the hand is found, and defaults that hit harder than before.
fn consent(plan: &Plan, before: &Params, args: &ApplyArgs) -> anyhow::Result<()> {
    let mut after = before.clone();
    for (id, value) in plan.rows.iter() {
        after.put(id, value);
    }
    let mut reasons: Vec<String> = worse(before, &after).iter().map(words::danger).collect();
    let places = plan.rows.iter().filter(|(id, _)| id.is_place());
    reasons.extend(places.map(|(id, value)| {
        format!(
            "{} becomes {value}: the hand may be found elsewhere",
            id.name()
        )
    }));
    match (reasons.is_empty(), args.yes) {
        (true, _) => Ok(()),
        (false, true) => {
            for reason in &reasons {
                say(&format!("warning: {reason}"));
            }
            Ok(())
        }
        (false, false) => Err(WrongUsage(format!(
            "{}; add --yes if you mean it; nothing was written",
            reasons.join("; ")
        ))
        .into()),
    }
}

/// Writes all settings of a plan. Rows of which it is not known what the hand holds are read once more, on a link that came back.
async fn write(talk: &mut Talk, plan: &Plan, before: &Params) -> anyhow::Result<Vec<RowEnd>> {
    let mut ends = Vec::new();
    for setting in &plan.settings {
        let mut written = talk.set(*setting).await?;
        if let Verdict::Unverified { .. } = written.verdict
            && talk.back().await.is_ok()
            && let Some(bytes) = talk.read_again(written.span).await
        {
            written = Written {
                verdict: Verdict::Differs,
                holds: Some(bytes),
                ..written
            };
        }
        ends.extend(plan::ends(plan, before, setting, &written));
    }
    Ok(ends)
}

/// Puts back what changed or may have; true if the hand holds again what it held.
async fn undo(talk: &mut Talk, ends: &[RowEnd], before: &Params) -> bool {
    let wanted = plan::undo(ends);
    if wanted.is_empty() {
        return true;
    }
    let Ok((live, _)) = talk.read().await else {
        return false;
    };
    let back = plan::plan(&wanted, &live);
    let Ok(put_back) = write(talk, &back, &live).await else {
        return false;
    };
    let is_back = |end: &RowEnd| end.holds.is_some() && end.holds == before.get(end.id);
    put_back.iter().all(is_back)
}
