//! `params backups`: the backups and the last save that this program keeps of a hand, without asking the hand.

use crate::cli::out::{Out, say};
use crate::cli::params::args::Common;
use crate::cli::params::words::known;
use crate::params::backups::Backup;
use crate::params::file::ParamsFile;
use anyhow::Context as _;
use serde_json::{Value, json};

/// Lists the backups, oldest first.
pub(crate) fn run(out: &mut Out, args: &Common) -> anyhow::Result<()> {
    let files = args.backups()?;
    let folder = files.folder();
    let backups = files
        .backups()
        .with_context(|| format!("cannot list {}", folder.display()))?;
    let known = known(&files)?;
    if args.json {
        return out.object(&json!({
            "hand": args.hand.to_string(),
            "folder": folder.display().to_string(),
            "saved": known.saved.as_ref().map(note),
            "doubtful": known.doubtful.as_ref().map(note),
            "backups": backups.iter().map(object).collect::<Vec<_>>(),
        }));
    }
    for backup in &backups {
        let path = backup.path.display();
        match &backup.file {
            Ok(file) => out.line(&format!("{}  {:<14} {path}", file.at, file.why))?,
            Err(error) => say(&format!("{path}: {error}")),
        }
    }
    out.line(&known.saved.map_or_else(
        || "this program has no confirmed save for this hand".into(),
        |file| format!("last saved {} ({})", file.at, file.verdict),
    ))?;
    out.lines(known.doubtful.map(|file| {
        let (at, verdict) = (file.at, file.verdict);
        format!("the result of the SAVE at {at} is not known ({verdict})")
    }))
}

fn object(backup: &Backup) -> Value {
    match &backup.file {
        Ok(file) => json!({ "path": backup.path, "at": file.at, "why": file.why }),
        Err(error) => json!({ "path": backup.path, "error": error.to_string() }),
    }
}

fn note(file: &ParamsFile) -> Value {
    json!({ "at": file.at, "verdict": file.verdict })
}
