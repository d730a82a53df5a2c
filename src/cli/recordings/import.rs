//! `import`: a session file out of values that `export --csv` wrote.

use crate::cli::out::Out;
use crate::cli::recordings::export::told;
use crate::record::import::csv::{self, ImportError};
use anyhow::anyhow;
use serde_json::json;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(crate) struct ImportArgs {
    /// Comma-separated values, as 'handscope export --csv' writes them
    #[arg(value_name = "FILE.csv")]
    file: PathBuf,
    /// The session file to write; it must not exist yet [default: FILE.mcap, beside the file]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Imports.
pub(crate) fn run(out: &mut Out, args: &ImportArgs) -> anyhow::Result<()> {
    let beside = || args.file.with_extension("mcap");
    let to = args.out.clone().unwrap_or_else(beside);
    let imported = csv::import(&args.file, &to).map_err(|error| {
        let file = args.file.display();
        match error {
            ImportError::Output(error) => told(error),
            ImportError::Unreadable { .. } => {
                anyhow!("cannot import {file}: {error}; check the path")
            }
            ImportError::Line { .. } => {
                anyhow!("cannot import {file}: {error}; nothing was written")
            }
        }
    })?;
    let mut lines = vec![format!("{} lines in {}", imported.rows, to.display())];
    if !imported.unknown.is_empty() {
        lines.push(format!("skipped columns: {}", imported.unknown.join(", ")));
    }
    if imported.incomplete_tips > 0 {
        lines.push(format!(
            "left out: {} readings of fingertips without all eight channels",
            imported.incomplete_tips
        ));
    }
    let object = json!({
        "file": to,
        "rows": imported.rows,
        "skipped_columns": imported.unknown,
        "incomplete_fingertips": imported.incomplete_tips,
    });
    out.result(args.json, &object, lines)
}
