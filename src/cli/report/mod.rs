//! `report`: everything that support asks for about a hand, in one ZIP file. Only reads from the hand.

mod contents;
mod recorded;
mod redaction;

use crate::cli::out::Out;
use crate::cli::out::failure::FailureKind;
use crate::cli::out::file::{check_folder, check_new_file, write_file};
use crate::cli::parse::seconds;
use crate::cli::report::contents::Contents;
use crate::cli::report::redaction::{COMPUTER, HOME, USER};
use crate::shell::interrupt::Interrupt;
use crate::transport::Endpoint;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// The hand to report on
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// The file to write, which must not exist yet [default: only list what it would contain]
    #[arg(long, value_name = "FILE.zip")]
    pub(crate) out: Option<PathBuf>,
    /// Seconds to record the hand once it answers
    #[arg(long = "for", value_name = "SECONDS", default_value = "10", value_parser = seconds)]
    pub(crate) length: Duration,
    /// Print JSON objects: the contents, then the file
    #[arg(long)]
    pub(crate) json: bool,
}

/// Collects the report, lists its contents, then writes it.
pub(crate) async fn run(out: &mut Out, args: &ReportArgs) -> anyhow::Result<()> {
    if let Some(path) = &args.out {
        may_be_written(path)?;
    }
    let mut interrupt = Interrupt::listen()?;
    let contents = tokio::select! {
        biased;
        () = interrupt.wished() => {
            let words = "ended before the report was complete; nothing was written";
            return Err(FailureKind::Interrupted.error(words));
        }
        contents = Contents::collect(&args.hand, args.length) => contents?,
    };
    out.result(args.json, &listed(args, &contents), lines(&contents))?;
    // A user sees the contents before the file exists.
    out.shown()?;
    let Some(path) = &args.out else {
        return Ok(());
    };
    let zip = contents.zip()?;
    write_file(path, &zip)?;
    let line = format!("written: {}, {} bytes", path.display(), zip.len());
    let object = json!({ "written": { "file": path, "bytes": zip.len() } });
    out.result(args.json, &object, [line])
}

/// Fails if the file cannot be created, before the hand is examined.
fn may_be_written(path: &Path) -> anyhow::Result<()> {
    check_new_file(path, "--out")?;
    check_folder(path, "--out")
}

fn listed(args: &ReportArgs, contents: &Contents) -> serde_json::Value {
    let files = contents
        .files
        .iter()
        .map(|file| json!({ "name": file.name, "bytes": file.bytes.len(), "about": file.about }));
    let missing = contents.missing.iter();
    let missing = missing.map(|one| json!({ "name": one.name, "why": one.why }));
    json!({ "report": {
        "hand": args.hand.to_string(),
        "files": files.collect::<Vec<_>>(),
        "missing": missing.collect::<Vec<_>>(),
    } })
}

fn lines(contents: &Contents) -> Vec<String> {
    let files = contents.files.iter().map(|file| {
        format!(
            "{:<15} {:>9} bytes  {}",
            file.name,
            file.bytes.len(),
            file.about
        )
    });
    let missing = contents.missing.iter();
    let missing = missing.map(|one| format!("{:<15} {:>15}  {}", one.name, "missing:", one.why));
    let redacted = format!(
        "home folder, user and computer are replaced by {HOME}, {USER} and {COMPUTER}; addresses, serial numbers and notes are not"
    );
    files.chain(missing).chain([redacted]).collect()
}
