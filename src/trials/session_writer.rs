//! Writes a session as its trials come. Never writes over another session; each file is whole at any moment, and after each
//! trial the session is complete up to it.

use crate::store;
use crate::trials::best::Criterion;
use crate::trials::recording::{TrialRecording, csv};
use crate::trials::report::Report;
use crate::trials::session::{FORMAT, SESSION_FILE, SessionHead, TrialSessionFile, VERSION};
use crate::trials::summary::{EarlyEnd, TrialSummary};
use std::io;
use std::path::{Path, PathBuf};

const REPORT_FILE: &str = "report.html";

/// A session that is being written.
#[derive(Debug)]
pub struct TrialSessionWriter {
    folder: PathBuf,
    file: TrialSessionFile,
    report: Report,
}

impl TrialSessionWriter {
    /// Makes the folder and writes what is known before the first trial. The report names the best setting by `criterion`.
    ///
    /// # Errors
    /// What the system says; a folder that holds anything is not taken.
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

    /// Writes one trial.
    ///
    /// # Errors
    /// What the system says.
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

    /// Notes what the whole session came to, under a key of its own.
    pub fn note(&mut self, key: &str, value: toml::Table) {
        self.file.head.others.insert(key.into(), value.into());
    }

    /// Writes how it ended, and the report.
    ///
    /// # Errors
    /// What the system says.
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
