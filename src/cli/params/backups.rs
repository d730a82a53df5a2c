//! `params backups`: what this program keeps of a hand. Asks the hand nothing.

use crate::cli::out::{Out, say};
use crate::cli::params::args::BackupsArgs;
use crate::cli::params::words::record;
use anyhow::{Context as _, anyhow};
use serde_json::{Value, json};

/// Lists the backups, oldest first.
pub(crate) fn run(out: &mut Out, args: &BackupsArgs) -> anyhow::Result<()> {
    let record = record(&args.common)?;
    let folder = record.folder().display().to_string();
    let backups = record
        .backups()
        .with_context(|| format!("cannot list {folder}"))?;
    let known = record
        .known()
        .map_err(|error| anyhow!("the record of this hand in {folder} cannot be used: {error}"))?;
    if args.common.json {
        let rows: Vec<Value> = backups
            .iter()
            .map(|backup| match &backup.about {
                Ok((at, why)) => json!({ "path": backup.path, "at": at, "why": why }),
                Err(error) => json!({ "path": backup.path, "error": error.to_string() }),
            })
            .collect();
        let note = |file: &Option<crate::app::params::file::ParamsFile>| {
            let file = file.as_ref();
            file.map(|file| json!({ "at": file.at, "verdict": file.verdict }))
        };
        let object = json!({
            "hand": args.common.hand.to_string(),
            "folder": folder,
            "saved": note(&known.saved),
            "doubtful": note(&known.doubtful),
            "backups": rows,
        });
        return out.line(&object.to_string());
    }
    for backup in &backups {
        match &backup.about {
            Ok((at, why)) => out.line(&format!("{at}  {why:<14} {}", backup.path.display()))?,
            Err(error) => say(&format!("{}: {error}", backup.path.display())),
        }
    }
    match &known.saved {
        Some(saved) => out.line(&format!("last saved {} ({})", saved.at, saved.verdict))?,
        None => out.line("nothing that this program saved is known to be in the hand's flash")?,
    }
    match &known.doubtful {
        Some(file) => out.line(&format!(
            "a SAVE of {} is of unknown result ({})",
            file.at, file.verdict
        )),
        None => Ok(()),
    }
}
