//! The parameter commands that only read: `params dump`, `params diff` and `params backups`.

use crate::cli::out::file::{check_new_file, write_file};
use crate::cli::out::{Out, end, notify};
use crate::cli::params::args::{Common, DiffArgs, DumpArgs};
use crate::cli::params::reach;
use crate::cli::params::words::{load, table};
use crate::link::RequestError;
use crate::params::backups::{Backup, Backups, Known};
use crate::params::file::ParamsFile;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::store::calendar::since_1970;
use crate::tasks::read;
use crate::transport::Endpoint;
use anyhow::{Context as _, anyhow, bail};
use serde_json::{Value, json};

/// Prints all parameters, and writes them to a file if requested. Fails if a row could not be read.
pub(crate) async fn dump(out: &mut Out, args: &DumpArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let files = common.backups()?;
    if let Some(path) = &args.out {
        check_new_file(path, "--out")?;
    }
    let (params, troubles) = read_rows(&common.hand).await?;
    let file = files.file(&params, "dump", since_1970());
    if let Some(path) = &args.out {
        write_file(path, file.to_toml().as_bytes())?;
    }
    let rows = ParamId::all().into_iter();
    let rows = rows.map(|id| (id, [params.get(id), id.factory()]));
    out.result(
        common.json,
        &json!({ "hand": file.hand, "at": file.at, "params": params }),
        table(["holds", "factory"], rows),
    )?;
    report_troubles(&troubles, true)
}

/// Values that the hand is compared with.
struct Other {
    params: Params,
    /// Title of the column.
    what: &'static str,
    notes: Vec<String>,
}

/// Compares the hand's parameters with a file, the last save, or the factory values. Fails if there is a difference, or a row
/// could not be read.
pub(crate) async fn diff(out: &mut Out, args: &DiffArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let other = other(args, &common.backups()?)?;
    let (live, troubles) = read_rows(&common.hand).await?;
    let differences = live.differences(&other.params);
    let differs = |id| differences.iter().any(|row| row.id == id);
    let is_shown = |id: &ParamId| differs(*id) || args.all && other.params.get(*id).is_some();
    let shown = ParamId::all().into_iter().filter(is_shown);
    let rows: Vec<_> = shown
        .map(|id| (id, [live.get(id), other.params.get(id)]))
        .collect();
    if common.json {
        let rows = rows.into_iter().map(|(id, [holds, other])| {
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
        if !rows.is_empty() {
            out.lines(table(["holds", other.what], rows))?;
        }
        out.lines(differences.is_empty().then_some("no difference"))?;
        other.notes.iter().for_each(|note| notify(note));
    }
    report_troubles(&troubles, differences.is_empty())
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
    let doubt = known.doubtful.map(|file| doubt("a later SAVE", &file));
    let Some(saved) = known.saved else {
        let more = doubt.map(|note| format!("; {note}")).unwrap_or_default();
        bail!(
            "this program has no confirmed save for the hand at {}{more}",
            args.common.hand,
        );
    };
    let notes = [
        format!("saved {} ({})", saved.at, saved.verdict_text()),
        "flash cannot be read: only after a power-up does the hand hold what is in it".into(),
    ];
    Ok(Other {
        params: saved.params,
        what: "saved",
        notes: doubt.into_iter().chain(notes).collect(),
    })
}

/// Lists the backups of a hand, oldest first, and its last save, without connecting to the hand.
pub(crate) fn backups(out: &mut Out, args: &Common) -> anyhow::Result<()> {
    let files = args.backups()?;
    let folder = files.folder();
    let backups = files
        .backups()
        .with_context(|| format!("cannot list {}", folder.display()))?;
    let known = known(&files)?;
    if args.json {
        let note = |file: &ParamsFile| json!({ "at": file.at, "verdict": file.verdict_text() });
        return out.object(&json!({
            "hand": args.hand.to_string(),
            "folder": folder.display().to_string(),
            "saved": known.saved.as_ref().map(note),
            "doubtful": known.doubtful.as_ref().map(note),
            "backups": backups.iter().map(backup_json).collect::<Vec<_>>(),
        }));
    }
    for backup in &backups {
        let path = backup.path.display();
        match &backup.file {
            Ok(file) => out.line(&format!("{}  {:<14} {path}", file.at, file.why))?,
            Err(error) => notify(&format!("{path}: {error}")),
        }
    }
    out.line(&known.saved.map_or_else(
        || "this program has no confirmed save for this hand".into(),
        |file| format!("last saved {} ({})", file.at, file.verdict_text()),
    ))?;
    out.lines(known.doubtful.map(|file| doubt("the SAVE", &file)))
}

fn backup_json(backup: &Backup) -> Value {
    match &backup.file {
        Ok(file) => json!({ "path": backup.path, "at": file.at, "why": file.why }),
        Err(error) => json!({ "path": backup.path, "error": error.to_string() }),
    }
}

fn doubt(what: &str, file: &ParamsFile) -> String {
    let (at, verdict) = (&file.at, file.verdict_text());
    format!("the result of {what} at {at} is not known ({verdict})")
}

/// This program's record of the hand's flash.
fn known(files: &Backups) -> anyhow::Result<Known> {
    let folder = files.folder().display();
    files
        .known()
        .map_err(|error| anyhow!("the record of this hand in {folder} cannot be used: {error}"))
}

/// All readable rows, and the errors of the others.
async fn read_rows(hand: &Endpoint) -> anyhow::Result<(Params, Vec<RequestError>)> {
    let link = reach::open(hand).await?;
    let read::ReadRows { params, troubles } = read::rows(&link, |_, _| ()).await;
    if params.is_empty() {
        let why = troubles.last().map(ToString::to_string).unwrap_or_default();
        bail!("cannot read any parameter of {hand}: {why}");
    }
    Ok((params, troubles))
}

/// Reports read errors. Fails if there are any, or if `is_well` is false.
fn report_troubles(troubles: &[RequestError], is_well: bool) -> anyhow::Result<()> {
    for trouble in troubles {
        notify(&format!("cannot read everything: {trouble}"));
    }
    end(is_well && troubles.is_empty())
}
