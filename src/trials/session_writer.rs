//! Writes a session trial by trial. Never overwrites another session; each file is replaced atomically, and after each trial the
//! session is complete up to it.

use crate::store;
use crate::trials::best::Criterion;
use crate::trials::recording::{TrialRecording, csv};
use crate::trials::report::Report;
use crate::trials::session::{FORMAT, SESSION_FILE, SessionHead, TrialSessionFile, VERSION};
use crate::trials::summary::{EarlyEnd, TrialSummary};
use std::io;
use std::path::{Path, PathBuf};

const REPORT_FILE: &str = "report.html";

/// A session being written.
#[derive(Debug)]
pub struct TrialSessionWriter {
    folder: PathBuf,
    file: TrialSessionFile,
    report: Report,
}

impl TrialSessionWriter {
    /// Creates the folder and writes the session without trials. The report names the best setting by `criterion`.
    ///
    /// # Errors
    /// The I/O error; a folder that is not empty is rejected.
    pub fn create(
        folder: &Path,
        head: SessionHead,
        criterion: Option<Criterion>,
    ) -> io::Result<Self> {
        store::create_empty_folder(folder)?;
        let writer = Self {
            folder: folder.to_owned(),
            file: TrialSessionFile {
                format: FORMAT.into(),
                version: VERSION,
                head,
                trials: Vec::new(),
            },
            report: Report::new(criterion),
        };
        writer.write_session()?;
        Ok(writer)
    }

    /// Adds a trial and writes its files.
    ///
    /// # Errors
    /// The I/O error.
    pub fn add(&mut self, summary: &TrialSummary, recording: &TrialRecording) -> io::Result<()> {
        let name = summary.samples_file();
        store::replace(&self.folder.join(&name), csv::write(recording).as_bytes())?;
        self.report.add(summary, recording);
        self.file.trials.push(TrialSummary {
            samples: Some(name),
            ..summary.clone()
        });
        self.write_session()
    }

    /// Adds a result of the whole session under its own key; written with the next trial or at the end.
    pub fn note(&mut self, key: &str, value: toml::Table) {
        self.file.head.others.insert(key.into(), value.into());
    }

    /// Writes the end of the session, and the report.
    ///
    /// # Errors
    /// The I/O error.
    pub fn finish(mut self, aborted: Option<EarlyEnd>) -> io::Result<()> {
        self.file.head.aborted = aborted;
        self.write_session()?;
        let page = self.report.html(&self.file).map_err(io::Error::other)?;
        store::replace(&self.folder.join(REPORT_FILE), page.as_bytes())
    }

    fn write_session(&self) -> io::Result<()> {
        let text = toml::to_string(&self.file).map_err(io::Error::other)?;
        store::replace(&self.folder.join(SESSION_FILE), text.as_bytes())
    }
}
