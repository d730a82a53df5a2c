//! Recording files named by the user: opening, time ranges in seconds from the start, and remarks on missing data.

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{WrongUsage, notify};
use crate::cli::parse::{RecordingTime, recording_time};
use crate::hand::Moment;
use crate::record::file::RecordingFile;
use crate::record::file::reader::{Damage, OpenError, TimeRange};
use anyhow::{Context as _, bail};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, IsTerminal as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A file of a recording.
#[derive(Debug, clap::Args)]
pub(crate) struct FileArgs {
    /// A recording file, as 'handscope record' and the window write it
    #[arg(value_name = "FILE.mcap")]
    pub(crate) file: PathBuf,
}

/// A stretch of a recording, in seconds from its start.
#[derive(Debug, clap::Args)]
pub(crate) struct StretchArgs {
    /// Begin here, in seconds from the recording's start, or with - before its end [default: at its start]
    #[arg(long, value_name = "SECONDS", value_parser = recording_time, allow_negative_numbers = true)]
    from: Option<RecordingTime>,
    /// End here [default: at its end]
    #[arg(long, value_name = "SECONDS", value_parser = recording_time, allow_negative_numbers = true)]
    to: Option<RecordingTime>,
}

impl StretchArgs {
    /// The time range in this file.
    pub(crate) fn of(&self, file: &RecordingFile) -> anyhow::Result<TimeRange> {
        let at = |time: RecordingTime| match time {
            RecordingTime::FromStart(step) => file.first().plus(step),
            RecordingTime::BeforeEnd(step) => file.first().plus(length(file).saturating_sub(step)),
        };
        let from = self.from.map_or(Moment::ZERO, at);
        let to = self.to.map_or(file.last(), at);
        let length_s = length(file).as_secs_f64();
        if from > to {
            bail!(
                "there is nothing between --from and --to: the recording is {length_s:.1} s long, and --from must be before --to"
            );
        }
        Ok(TimeRange {
            from,
            to,
            wire: true,
        })
    }
}

pub(crate) fn open(path: &Path) -> anyhow::Result<RecordingFile> {
    opened(RecordingFile::open(path), path)
}

/// True if the path denotes standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Opens a file, or the contents of standard input.
pub(crate) fn open_or_stdin(path: &Path) -> anyhow::Result<RecordingFile> {
    if is_standard(path) {
        opened(
            RecordingFile::of(stdin_as_file()?, path),
            Path::new("standard input"),
        )
    } else {
        open(path)
    }
}

/// Copies standard input to an unnamed temporary file that disappears with the program.
pub(crate) fn stdin_as_file() -> anyhow::Result<File> {
    let mut from = io::stdin().lock();
    if from.is_terminal() {
        return Err(WrongUsage::error(
            "- reads a file from standard input, and that is a terminal; name a file, or pipe one into it",
        ));
    }
    let mut file = tempfile::tempfile().context("cannot buffer standard input")?;
    io::copy(&mut from, &mut file).context("cannot buffer standard input")?;
    Ok(file)
}

fn opened(file: Result<RecordingFile, OpenError>, path: &Path) -> anyhow::Result<RecordingFile> {
    file.map_err(|error| {
        let is_csv = path.extension().is_some_and(|ending| ending == "csv");
        let what_to_do = match error {
            OpenError::Unreadable { .. } => "check the path",
            OpenError::NotMcap if is_csv => "make a recording file of it with 'handscope import'",
            OpenError::NotAFile | OpenError::NotMcap => {
                "name a recording file of 'handscope record' or of the window, or a folder of rosbag2"
            }
            OpenError::Foreign => "only recordings of Handscope can be opened",
            OpenError::SeveralHands { .. } => {
                "split them with the program that merged them"
            }
            OpenError::TooMuch { .. } => "only recordings of Handscope can be opened",
            OpenError::Empty => "there is nothing to recover",
        };
        FailureKind::File.error(format!(
            "cannot open {}: {error}; {what_to_do}",
            path.display()
        ))
    })
}

/// Length of a recording.
pub(crate) fn length(file: &RecordingFile) -> Duration {
    file.last().since(file.first())
}

/// Names the files of a recording that has several.
pub(crate) fn add_files(object: &mut Value, file: Option<&RecordingFile>) {
    let files: Vec<&Path> = file.into_iter().flat_map(RecordingFile::paths).collect();
    if let Some(fields) = object.as_object_mut().filter(|_| files.len() > 1) {
        fields.insert("files".into(), json!(files));
    }
}

/// Describes the unreadable parts; `None` if all could be read.
pub(crate) fn lost(damage: &Damage) -> Option<String> {
    let Damage {
        chunks,
        bytes,
        messages,
        ref gaps,
    } = *damage;
    let chunks = (chunks > 0).then(|| {
        let (noun, verb) = if chunks == 1 {
            ("piece", "is")
        } else {
            ("pieces", "are")
        };
        let fate = if messages == 0 && gaps.is_empty() {
            ", but no message is missing by its number"
        } else {
            " and left out"
        };
        format!("{chunks} {noun} {verb} damaged{fate}")
    });
    let bytes = (bytes > 0).then(|| format!("{bytes} bytes hold no record"));
    let messages = (messages > 0).then(|| format!("{messages} messages are missing"));
    let length = damage.length().as_secs_f64();
    let gaps = (!gaps.is_empty()).then(|| format!("{length:.3} s in all"));
    let words = [chunks, bytes, messages, gaps].into_iter().flatten();
    let words: Vec<String> = words.collect();
    (!words.is_empty()).then(|| words.join(", "))
}

/// Reports remarks on the state of the file on standard error.
pub(crate) fn report_remarks(file: &RecordingFile) {
    for remark in file.remarks() {
        notify(&format!("{}: {remark}", file.path().display()));
    }
}
