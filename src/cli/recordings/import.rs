//! `import`: creates a recording file from values that `export --csv` wrote.

use crate::cli::out::ending::EndFlag;
use crate::cli::out::failure::FailureKind;
use crate::cli::out::progress::ProgressLine;
use crate::cli::out::{Out, WrongUsage, notify};
use crate::cli::recordings::export::explained;
use crate::cli::recordings::recording_file::{is_standard, stdin_as_file};
use crate::record::export::Destination;
use crate::record::import::csv::{self, ImportError, Imported};
use serde_json::json;
use std::cell::Cell;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufReader, IsTerminal as _, Read, Seek as _};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(crate) struct ImportArgs {
    /// Comma-separated values, as 'handscope export --csv' writes them, also after pandas or polars; - reads them from standard input
    #[arg(value_name = "FILE.csv", required = true, num_args = 1..)]
    files: Vec<PathBuf>,
    /// The recording file to write, which must not exist yet; - is standard output [default: FILE.mcap, beside the file]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Print one JSON object for each file
    #[arg(long)]
    json: bool,
}

impl ImportArgs {
    /// Checks that clap cannot do.
    fn check(&self) -> anyhow::Result<()> {
        let from_stdin = self.files.iter().any(|file| is_standard(file));
        let to_stdout = self.out.as_deref().is_some_and(is_standard);
        let why = match &self.out {
            Some(_) if self.files.len() > 1 => {
                "--out names one file: leave it out, and each is made beside its values"
            }
            None if from_stdin => "name the recording file with --out",
            _ if to_stdout && self.json => {
                "standard output holds the recording file: leave out --json"
            }
            _ if to_stdout && io::stdout().is_terminal() => {
                "a recording file is not text for a terminal: pipe it into a program, or name a file with --out"
            }
            _ => return Ok(()),
        };
        Err(WrongUsage::error(why))
    }
}

pub(crate) fn run(out: &mut Out, args: &ImportArgs) -> anyhow::Result<()> {
    args.check()?;
    args.files
        .iter()
        .try_for_each(|file| import(out, args, file))
}

fn import(out: &mut Out, args: &ImportArgs, file: &Path) -> anyhow::Result<()> {
    let name = if is_standard(file) {
        "standard input".into()
    } else {
        file.display().to_string()
    };
    let beside = || file.with_extension("mcap");
    let path = args.out.clone().unwrap_or_else(beside);
    let to = if is_standard(&path) {
        Destination::Stdout
    } else {
        Destination::Path(path.clone())
    };
    let unread = |error: &dyn Display| {
        FailureKind::File.error(format!("cannot import {name}: {error}; check the path"))
    };
    let from = if is_standard(file) {
        stdin_as_file()?
    } else {
        File::open(file).map_err(|error| unread(&error))?
    };
    let imported = values(from, &to).map_err(|error| match error {
        ImportError::Output(error) => explained(error),
        ImportError::Unreadable { .. } => unread(&error),
        ImportError::Line { .. } => FailureKind::File.error(format!(
            "cannot import {name}: {error}; nothing was written"
        )),
    })?;
    let mut lines = vec![format!("{} lines in {}", imported.rows, path.display())];
    if !imported.unknown.is_empty() {
        lines.push(format!("skipped columns: {}", imported.unknown.join(", ")));
    }
    if imported.counts_from_1970 {
        lines.push("its times count from 1970: the recording begins with the first line".into());
    }
    if imported.has_grip {
        lines.push(
            "left out: the columns of the grip: it is inferred from readings of which a table does not hold the status, so it is unknown in the recording".into(),
        );
    }
    if imported.incomplete_tips > 0 {
        lines.push(format!(
            "left out: {} readings of fingertips without all eight channels",
            imported.incomplete_tips
        ));
    }
    if to == Destination::Stdout {
        lines.iter().for_each(|line| notify(line));
        return Ok(());
    }
    let object = json!({
        "file": path,
        "rows": imported.rows,
        "skipped_columns": imported.unknown,
        "grip_left_out": imported.has_grip,
        "counts_from_1970": imported.counts_from_1970,
        "incomplete_fingertips": imported.incomplete_tips,
    });
    out.result(args.json, &object, lines)
}

/// Imports, with progress reports.
fn values(mut from: File, to: &Destination) -> Result<Imported, ImportError> {
    let unreadable = |error: io::Error| ImportError::Unreadable {
        message: error.to_string(),
    };
    let unlistened = |error: anyhow::Error| ImportError::Unreadable {
        message: error.to_string(),
    };
    // The temporary file of standard input was written just now, and must be rewound.
    let is_plain = from.metadata().map_err(unreadable)?.is_file();
    if is_plain {
        from.rewind().map_err(unreadable)?;
    }
    let wished = match to {
        Destination::Stdout => EndFlag::never(),
        Destination::Path(_) => EndFlag::listen().map_err(unlistened)?,
    };
    let length = from.metadata().map_or(0, |data| data.len());
    let (progress, read) = (ProgressLine::new(), Cell::new(0));
    let from = CountedRead { from, read: &read };
    csv::import(BufReader::new(from), to, &|| {
        progress.report(share(read.get(), length));
        wished.flow()
    })
}

#[expect(clippy::cast_precision_loss, reason = "far below 2^53 bytes")]
fn share(read: u64, length: u64) -> f64 {
    (read as f64 / length.max(1) as f64).min(1.0)
}

/// A file that counts the bytes read.
struct CountedRead<'a> {
    from: File,
    read: &'a Cell<u64>,
}

impl Read for CountedRead<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.from.read(into)?;
        self.read
            .update(|read| read + u64::try_from(count).unwrap_or(0));
        Ok(count)
    }
}
