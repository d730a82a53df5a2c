//! `params diff`: compares the hand's parameters with a file, the last save, or the factory values. Only reads.

use crate::cli::out::{Out, say};
use crate::cli::params::args::DiffArgs;
use crate::cli::params::reach::{read_rows, say_troubles};
use crate::cli::params::words::{known, load, table};
use crate::cli::session;
use crate::params::backups::Backups;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use anyhow::bail;
use serde_json::json;

/// What the hand is compared with.
struct Other {
    params: Params,
    /// Its name, for the head of the column.
    what: &'static str,
    /// Notes about it.
    notes: Vec<String>,
}

/// Compares and prints. Fails if there is a difference, or a row could not be read.
pub(crate) fn run(out: &mut Out, args: &DiffArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let other = other(args, &common.backups()?)?;
    let (live, troubles) = session::runtime()?.block_on(read_rows(&common.hand))?;
    let differences = live.differences(&other.params);
    let differs = |id| differences.iter().any(|row| row.id == id);
    let is_shown = |id: &ParamId| differs(*id) || args.all && other.params.get(*id).is_some();
    let shown = ParamId::all().into_iter().filter(is_shown);
    let mut rows = shown
        .map(|id| (id, [live.get(id), other.params.get(id)]))
        .peekable();
    if common.json {
        let rows = rows.map(|(id, [holds, other])| {
            json!({ "name": id, "holds": holds, "other": other, "same": !differs(id) })
        });
        out.object(&json!({
            "hand": common.hand.to_string(),
            "against": other.what,
            "differences": differences.len(),
            "rows": rows.collect::<Vec<_>>(),
            "notes": other.notes,
        }))?;
    } else {
        if rows.peek().is_some() {
            out.lines(table(["holds", other.what], rows))?;
        }
        if differences.is_empty() {
            out.line("no difference")?;
        }
        other.notes.iter().for_each(|note| say(note));
    }
    say_troubles(&troubles, differences.is_empty())
}

fn other(args: &DiffArgs, files: &Backups) -> anyhow::Result<Other> {
    if args.factory {
        return Ok(Other {
            params: Params::factory(),
            what: "factory",
            notes: vec!["the manual prints no factory value for speeds and forces".into()],
        });
    }
    if let Some(path) = &args.file {
        let (file, note) = load(path)?;
        return Ok(Other {
            params: file.params,
            what: "file",
            notes: note.into_iter().collect(),
        });
    }
    let known = known(files)?;
    let doubt = known.doubtful.map(|file| {
        let (at, verdict) = (file.at, file.verdict);
        format!("the result of a later SAVE at {at} is not known ({verdict})")
    });
    let Some(saved) = known.saved else {
        let more = doubt.map(|note| format!("; {note}")).unwrap_or_default();
        bail!(
            "this program has no confirmed save for the hand at {}{more}",
            args.common.hand,
        );
    };
    let notes = [
        format!("saved {} ({})", saved.at, saved.verdict),
        "flash cannot be read: only after a power-up does the hand hold what is in it".into(),
    ];
    Ok(Other {
        params: saved.params,
        what: "saved",
        notes: doubt.into_iter().chain(notes).collect(),
    })
}
