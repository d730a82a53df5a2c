//! `params diff`: what the hand holds against a file, against what was saved last, or against the factory's. Reads only.

use crate::app::params::file;
use crate::app::params::record::Record;
use crate::app::params::table::ParamId;
use crate::app::params::values::Params;
use crate::cli::out::{Out, Told, say};
use crate::cli::params::args::DiffArgs;
use crate::cli::params::show;
use crate::cli::params::talk::Talk;
use crate::cli::params::words::{or_dash, record};
use crate::cli::session;
use anyhow::{anyhow, bail};
use serde_json::{Value, json};

/// What the hand is compared with.
struct Other {
    params: Params,
    /// What it is, for the head of the column.
    what: &'static str,
    /// What should be known of it.
    notes: Vec<String>,
}

/// Compares and prints. Fails if there is a difference, or a row could not be read.
pub(crate) fn run(out: &mut Out, args: &DiffArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let other = other(args, &record(common)?)?;
    let (live, troubles) = session::runtime()?.block_on(async {
        let mut talk = Talk::open(&common.hand).await?;
        talk.read().await
    })?;
    let differences = live.differences(&other.params);
    let differs = |id| differences.iter().any(|row| row.id == id);
    let rows = ParamId::all().into_iter();
    let shown: Vec<ParamId> = rows
        .filter(|id| differs(*id) || args.all && other.params.get(*id).is_some())
        .collect();
    if common.json {
        let rows: Vec<Value> = shown
            .iter()
            .map(|id| {
                json!({
                    "name": id.name(),
                    "holds": show::json_of(live.get(*id)),
                    "other": show::json_of(other.params.get(*id)),
                    "same": !differs(*id),
                })
            })
            .collect();
        let object = json!({
            "hand": common.hand.to_string(),
            "against": other.what,
            "differences": differences.len(),
            "rows": rows,
            "notes": other.notes,
        });
        out.line(&object.to_string())?;
    } else {
        if !shown.is_empty() {
            out.line(&show::head(&["holds", other.what]))?;
        }
        for id in shown {
            let columns = [or_dash(live.get(id)), or_dash(other.params.get(id))];
            out.line(&show::line(id, &columns))?;
        }
        if differences.is_empty() {
            out.line("no difference")?;
        }
        for note in &other.notes {
            say(note);
        }
    }
    for trouble in &troubles {
        say(&format!("cannot read everything: {trouble}"));
    }
    match differences.is_empty() && troubles.is_empty() {
        true => Ok(()),
        false => Err(Told.into()),
    }
}

fn other(args: &DiffArgs, record: &Record) -> anyhow::Result<Other> {
    if args.factory {
        return Ok(Other {
            params: Params::factory(),
            what: "factory",
            notes: vec!["the manual prints no factory value for speeds and forces".into()],
        });
    }
    if let Some(path) = &args.file {
        let file = file::load(path).map_err(|error| anyhow!("{}: {error}", path.display()))?;
        let unknown = file.unknown_keys();
        let notes = match unknown.is_empty() {
            true => Vec::new(),
            false => vec![format!("keys that are not known: {}", unknown.join(", "))],
        };
        return Ok(Other {
            params: file.params,
            what: "file",
            notes,
        });
    }
    let known = record.known().map_err(|error| {
        anyhow!(
            "the record of this hand in {} cannot be used: {error}",
            record.folder().display()
        )
    })?;
    let mut notes = Vec::new();
    if let Some(doubtful) = &known.doubtful {
        notes.push(format!(
            "a later SAVE, {}, is of unknown result ({})",
            doubtful.at, doubtful.verdict
        ));
    }
    let Some(saved) = known.saved else {
        let more = notes.pop().map(|note| format!("; {note}"));
        bail!(
            "this program has not saved anything in the hand at {} that is known to be there{}",
            args.common.hand,
            more.unwrap_or_default()
        );
    };
    notes.push(format!("saved {} ({})", saved.at, saved.verdict));
    notes.push(
        "flash itself cannot be read: only after a power-up the hand holds what is in it".into(),
    );
    Ok(Other {
        params: saved.params,
        what: "saved",
        notes,
    })
}
