//! Contents of a report: each file with its text redacted, and what is missing. Writes no file but temporary ones.

use crate::app::env::day_folder;
use crate::app::files::settings_file;
use crate::checkup::kept;
use crate::cli::doctor::diagnose;
use crate::cli::report::recorded::{self, HandNow};
use crate::cli::report::redaction::Redaction;
use crate::cli::session::PORT_RESTS;
use crate::hand::Moment;
use crate::link::quirks::book::QuirkBook;
use crate::motion::checkup::CheckupFiles;
use crate::record::export::{Destination, ExportSource, cut};
use crate::record::file::RecordingFile;
use crate::record::file::reader::TimeRange;
use crate::store::{calendar, on_thread, read_text};
use crate::transport::Endpoint;
use anyhow::Context as _;
use serde_json::{Value, json};
use std::io::{self, Cursor, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Maximum time that the connection is examined, as 'handscope doctor' does by default.
const DOCTOR_DURATION_MAX: Duration = Duration::from_secs(5);
/// Part of the newest recording that is included, at its end.
const RECORDING_LENGTH: Duration = Duration::from_secs(60);
/// Check-ups that are included: the first, with which the others are compared, and the last.
const CHECKUPS_MAX: usize = 4;
/// Maximum size of the settings in bytes.
const SETTINGS_MAX: u64 = 1 << 20;

/// One file of a report.
pub(super) struct ReportFile {
    pub(super) name: &'static str,
    /// Its content, in words.
    pub(super) about: String,
    pub(super) bytes: Vec<u8>,
}

/// Something that a report should contain, and why it does not.
pub(super) struct Missing {
    pub(super) name: &'static str,
    pub(super) why: String,
}

/// All files of a report.
pub(super) struct Contents {
    pub(super) files: Vec<ReportFile>,
    pub(super) missing: Vec<Missing>,
    redaction: Redaction,
    hand: Endpoint,
    /// Time that the hand is recorded.
    length: Duration,
}

impl Contents {
    /// Examines and records the hand, and collects what is stored about it.
    pub(super) async fn collect(hand: &Endpoint, length: Duration) -> anyhow::Result<Self> {
        let mut contents = Self {
            files: Vec::new(),
            missing: Vec::new(),
            redaction: Redaction::of_this_user(),
            hand: hand.clone(),
            length,
        };
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let answers = contents.examine().await?;
        let settings = settings_file::default_path();
        contents
            .add_now(answers, settings.as_deref(), folder.path())
            .await?;
        contents.add_settings(settings.as_deref());
        contents.add_checkups(settings.as_deref());
        contents.json(
            "versions.json",
            "versions of the program and of the system",
            &versions(),
        );
        Ok(contents)
    }

    /// Adds the result of `doctor`. Returns true if the hand answers.
    async fn examine(&mut self) -> anyhow::Result<bool> {
        let length = self.length.min(DOCTOR_DURATION_MAX);
        let diagnosed = diagnose(&self.hand, length).await?;
        let about = match diagnosed.wrong {
            0 => "the connection: nothing is wrong".to_owned(),
            1 => "the connection: one thing is wrong".to_owned(),
            count => format!("the connection: {count} things are wrong"),
        };
        self.text("doctor.txt", about, &(diagnosed.lines.join("\n") + "\n"));
        self.json(
            "doctor.json",
            "the same as 'doctor --json' has it",
            &diagnosed.object,
        );
        Ok(diagnosed.answers)
    }

    /// Adds the hand as it is now, and what was recorded of it before.
    async fn add_now(
        &mut self,
        answers: bool,
        settings: Option<&Path>,
        folder: &Path,
    ) -> anyhow::Result<()> {
        let path = folder.join("raw.mcap");
        let now = match answers {
            true => {
                tokio::time::sleep(PORT_RESTS).await;
                HandNow::record(&self.hand, self.length, path).await
            }
            false => Err(anyhow::anyhow!("the hand does not answer")),
        };
        let hand = self.hand.clone();
        let recordings = recordings_folder(settings);
        let newest = on_thread(move || {
            let newest = recordings.map(|folder| recorded::newest(&folder, &hand));
            Ok(newest.unwrap_or_default())
        });
        let newest = newest.await?;
        let now = match now {
            Ok(now) => Some(now),
            Err(error) => {
                self.missing("now.mcap", format!("{error:#}"));
                None
            }
        };
        let faults = json!({
            "now": now.as_ref().and_then(|now| now.faults.clone()),
            "recorded": recorded::faults(&newest),
        });
        self.json(
            "faults.json",
            "faults of the drives: now, and in the last recordings",
            &faults,
        );
        self.add_quirks(now.as_ref(), settings);
        if let Some(now) = &now {
            let about = format!("the hand now, {:.0} s", self.length.as_secs_f64());
            self.recording("now.mcap", about, &now.recording, folder)?;
        }
        match newest.first() {
            Some(file) => {
                let title = file.path().file_name().unwrap_or_default();
                let about = format!(
                    "the end of the newest recording, {}, at most {} s",
                    title.to_string_lossy(),
                    RECORDING_LENGTH.as_secs()
                );
                self.recording("recording.mcap", about, file, folder)?;
            }
            None => self.missing("recording.mcap", "there is no recording of this hand"),
        }
        Ok(())
    }

    /// Adds the quirks as found now, or as stored by the window.
    fn add_quirks(&mut self, now: Option<&HandNow>, settings: Option<&Path>) {
        let (place, id) = self.hand.place_and_id();
        let book = settings
            .map(QuirkBook::path)
            .map(|path| QuirkBook::load(&path));
        let known = book.and_then(Result::ok).and_then(|book| {
            let mut sheets = book.hands.into_iter();
            sheets.find(|sheet| sheet.place == place && sheet.id == id)
        });
        match now.map(|now| now.sheet.clone()).or(known) {
            Some(sheet) => {
                let text = QuirkBook::of(sheet).to_toml();
                self.text(
                    "quirks.toml",
                    "how this hand differs from others".into(),
                    &text,
                );
            }
            None => self.missing("quirks.toml", "nothing is known of this hand"),
        }
    }

    fn add_settings(&mut self, settings: Option<&Path>) {
        match settings.map(|path| read_text(path, SETTINGS_MAX)) {
            Some(Ok(Some(text))) => {
                self.text("settings.toml", "the settings of the window".into(), &text);
            }
            Some(Err(error)) => self.missing("settings.toml", error.to_string()),
            Some(Ok(None)) | None => self.missing("settings.toml", "no settings are stored"),
        }
    }

    fn add_checkups(&mut self, settings: Option<&Path>) {
        let folder = settings.map(|path| path.with_file_name("checks"));
        let file = folder.and_then(|folder| CheckupFiles::kept_in(&folder, &self.hand));
        let mut all = match file.map_or(Ok(Vec::new()), |file| kept::read(&file)) {
            Ok(all) => all,
            Err(error) => return self.missing("checkups.jsonl", error.to_string()),
        };
        if all.is_empty() {
            return self.missing("checkups.jsonl", "no check-up of this hand is stored");
        }
        let count = all.len();
        all.drain(1..count.saturating_sub(CHECKUPS_MAX - 1).max(1));
        let about = format!("{} of {count} check-ups: the first and the last", all.len());
        let lines: Vec<String> = all.iter().map(|one| json!(one).to_string()).collect();
        self.text("checkups.jsonl", about, &(lines.join("\n") + "\n"));
    }

    /// Adds the last minute of a recording.
    fn recording(
        &mut self,
        name: &'static str,
        about: String,
        file: &RecordingFile,
        folder: &Path,
    ) -> anyhow::Result<()> {
        let length = file.last().since(file.first());
        let from = file.first().plus(length.saturating_sub(RECORDING_LENGTH));
        let stretch = TimeRange {
            from: if length > RECORDING_LENGTH {
                from
            } else {
                Moment::ZERO
            },
            to: file.last(),
            wire: true,
        };
        let path = folder.join(name);
        let redaction = self.redaction.clone();
        let redacted = |text: &str| redaction.text(text);
        let to = Destination::Path(path.clone());
        match cut::rewrite(ExportSource::new(file, stretch), &to, &redacted) {
            Ok(_exported) => {
                let bytes = std::fs::read(&path).context("cannot read a temporary file")?;
                let about = self.redaction.text(&about);
                self.files.push(ReportFile { name, about, bytes });
            }
            Err(error) => self.missing(name, error.to_string()),
        }
        Ok(())
    }

    fn json(&mut self, name: &'static str, about: &str, object: &Value) {
        let text = serde_json::to_string_pretty(object).unwrap_or_default();
        self.text(name, about.into(), &(text + "\n"));
    }

    fn text(&mut self, name: &'static str, about: String, text: &str) {
        let bytes = self.redaction.text(text).into_bytes();
        self.files.push(ReportFile { name, about, bytes });
    }

    fn missing(&mut self, name: &'static str, why: impl Into<String>) {
        let why = self.redaction.text(&why.into());
        self.missing.push(Missing { name, why });
    }

    /// The files as a ZIP archive. Recordings are compressed already, and the rest is small.
    pub(super) fn zip(&self) -> io::Result<Vec<u8>> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        for file in &self.files {
            zip.start_file(file.name, options)?;
            zip.write_all(&file.bytes)?;
        }
        Ok(zip.finish()?.into_inner())
    }
}

/// Folder of the recordings, as the window has it.
fn recordings_folder(settings: Option<&Path>) -> Option<PathBuf> {
    let known = settings.and_then(settings_file::peek).unwrap_or_default();
    known.recordings_folder(day_folder::documents().as_deref())
}

fn versions() -> Value {
    // Linux only; elsewhere there are no such files.
    let first_line = |path: &str| {
        let text = read_text(Path::new(path), SETTINGS_MAX).ok().flatten()?;
        text.lines().next().map(ToOwned::to_owned)
    };
    let release = read_text(Path::new("/etc/os-release"), SETTINGS_MAX);
    let release = release.ok().flatten().and_then(|text| {
        let mut names = text
            .lines()
            .filter_map(|line| line.strip_prefix("PRETTY_NAME="));
        names.next().map(|name| name.trim_matches('"').to_owned())
    });
    json!({
        "handscope": env!("CARGO_PKG_VERSION"),
        "made_at": calendar::stamp(calendar::since_1970()),
        "system": std::env::consts::OS,
        "architecture": std::env::consts::ARCH,
        "release": release,
        "kernel": first_line("/proc/sys/kernel/osrelease"),
        "language": std::env::var("LANG").ok(),
    })
}
