//! The report of the day, stored in a file with an HTML page next to it, in the background. Counting resumes after a
//! restart.

use crate::app::env::day_folder;
use crate::app::files::put_aside;
use crate::app::hand::Hand;
use crate::app::notices::NoticeKind;
use crate::exhibit::report::{DayReport, file, page};
use crate::exhibit::stage::ExhibitEvent;
use crate::hand::Moment;
use crate::store::calendar;
use crate::store::saver::NotSaved;
use crate::store::{Background, FileError, JobKind, Jobs, on_thread, read_text, replace};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::Handle;

/// Minimum interval between writes: a crash loses at most one minute.
const WRITE_EVERY: Duration = Duration::from_secs(60);
/// Maximum size of a report in bytes: ten times a day of a hundred pieces.
const FILE_LEN_MAX: u64 = 256 * 1024;

/// Stored report of the day, and a notice for the user about the file.
type ReadReport = (Option<DayReport>, Option<NoticeKind>);

/// Today's report and its file. Without a documents folder nothing is stored.
#[derive(Debug)]
pub struct StoredReport {
    today: DayReport,
    documents: Option<PathBuf>,
    runtime: Handle,
    /// Contents of the file, including a write in progress.
    written: DayReport,
    jobs: Jobs<ReportJob>,
    begun: Option<Moment>,
    /// True once the file of the day was read, was missing, or was set aside. Until then it must not be overwritten.
    may_write: bool,
    unreadable: Option<NoticeKind>,
    not_saved: Option<NoticeKind>,
}

/// Background jobs of the report.
#[derive(Debug, PartialEq, Eq)]
enum ReportJob {
    Read,
    Write,
}

impl JobKind for ReportJob {
    type State = StoredReport;
    type Ctx<'a> = ();
}

impl StoredReport {
    /// Creates an empty report; reads and counts nothing before the first [`StoredReport::tick`].
    pub(crate) fn new(documents: Option<PathBuf>, runtime: Handle) -> Self {
        Self {
            today: DayReport::default(),
            documents,
            runtime,
            written: DayReport::default(),
            jobs: Jobs::default(),
            begun: None,
            may_write: false,
            unreadable: None,
            not_saved: None,
        }
    }

    /// Today's counts.
    pub const fn today(&self) -> &DayReport {
        &self.today
    }

    /// Notices about reading and saving that have failed.
    pub fn troubles(&self) -> impl Iterator<Item = &NoticeKind> {
        self.unreadable.iter().chain(&self.not_saved)
    }

    /// Counts an event. Call [`StoredReport::tick`] first.
    pub(crate) fn count(&mut self, event: &ExhibitEvent) {
        self.today.count(event);
    }

    /// Records the state of the hand at this time since 1970; reads and writes files when due.
    pub(crate) fn tick(&mut self, hand: &Hand, since_1970: Duration, now: Moment) {
        self.apply_ended();
        let day = calendar::day(since_1970);
        let is_over = self.today.day != day;
        if !is_over {
            self.see(hand, since_1970, now);
        }
        if self.is_busy() {
            return;
        }
        let is_due = |at| is_over || now.since(at) >= WRITE_EVERY;
        if self.today != self.written {
            if self.begun.is_none_or(is_due) {
                self.write(now);
            }
        } else if is_over {
            self.begin_day(day);
        }
    }

    /// Writes unsaved changes. Returns true once everything is saved, or cannot be.
    pub(crate) fn flush(&mut self, now: Moment) -> bool {
        self.apply_ended();
        if !self.is_busy() && self.today != self.written {
            self.write(now);
        }
        !self.is_busy()
    }

    /// True while a read or write is in progress.
    pub(crate) const fn is_busy(&self) -> bool {
        !self.jobs.is_empty()
    }

    fn see(&mut self, hand: &Hand, since_1970: Duration, now: Moment) {
        if let Some(endpoint) = &hand.connection.endpoint
            && hand.connection.status.state.is_live()
        {
            self.today.hands.insert(endpoint.to_string());
        }
        if let Ok(hour) = u8::try_from(since_1970.as_secs() / 3600 % 24) {
            self.today.warm(&hand.readings.sample, hour, now);
        }
    }

    fn begin_day(&mut self, day: String) {
        self.today = DayReport::of(&day);
        self.written = self.today.clone();
        self.may_write = false;
        if let Some(path) = self.path() {
            let read = on_thread(move || Ok(load(&path, &day)));
            let background = Background {
                runtime: &self.runtime,
                wake: &no_wake(),
            };
            self.jobs
                .start(ReportJob::Read, background, read, |report, (), read| {
                    if let Ok(read) = read {
                        report.apply_read(read);
                    }
                });
        }
    }

    /// Path of the day's report; its page lies next to it.
    fn path(&self) -> Option<PathBuf> {
        let (documents, day) = (self.documents.as_deref()?, &self.today.day);
        Some(day_folder::of_day(documents, day).join(format!("exhibit-{day}.toml")))
    }

    fn write(&mut self, now: Moment) {
        // A failed write is not repeated until something changes.
        self.written = self.today.clone();
        self.begun = Some(now);
        if let Some(path) = self.path().filter(|_| self.may_write) {
            let report = self.written.clone();
            let write = on_thread(move || Ok(save(&path, &report)));
            let background = Background {
                runtime: &self.runtime,
                wake: &no_wake(),
            };
            self.jobs.start(
                ReportJob::Write,
                background,
                write,
                |report, (), written| {
                    if let Ok(written) = written {
                        report.apply_written(written);
                    }
                },
            );
        }
    }

    fn apply_ended(&mut self) {
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, &mut ());
        }
    }

    fn apply_read(&mut self, (earlier, notice): ReadReport) {
        let is_aside = |notice: &NoticeKind| matches!(notice, NoticeKind::FileIgnored { kept_as, .. } if kept_as.is_some());
        self.may_write = notice.as_ref().is_none_or(is_aside);
        self.unreadable = notice.or(self.unreadable.take());
        if let Some(earlier) = earlier {
            self.today.add(&earlier);
            self.written = earlier;
        }
    }

    fn apply_written(&mut self, written: Result<(), NotSaved>) {
        match written {
            Err((path, error)) => {
                self.not_saved = Some(NoticeKind::not_saved(path, &error));
            }
            Ok(()) => {
                // A successful write clears the failure of the same day.
                let day = self.path();
                self.not_saved.take_if(|notice| match notice {
                    NoticeKind::NotSaved { path, .. } => Some(path.with_extension("toml")) == day,
                    _ => false,
                });
            }
        }
    }
}

/// Loads the report of the day, if there is one. An unreadable file is set aside, with a notice.
fn load(path: &Path, day: &str) -> ReadReport {
    let read = || -> Result<Option<DayReport>, FileError> {
        let text = read_text(path, FILE_LEN_MAX)?;
        text.map(|text| file::read(&text, day)).transpose()
    };
    match read() {
        Ok(earlier) => (earlier, None),
        Err(error) => (None, Some(put_aside(path, error))),
    }
}

fn save(path: &Path, report: &DayReport) -> Result<(), NotSaved> {
    let put = |path: &Path, text: io::Result<String>| {
        let written = text.and_then(|text| replace(path, text.as_bytes()));
        written.map_err(|error| (path.to_owned(), error))
    };
    put(path, file::write(report).map_err(io::Error::other))?;
    let page = page::html(report).map_err(io::Error::other);
    put(&path.with_extension("html"), page)
}

/// A no-op wake: reading and writing do not change the display.
fn no_wake() -> Arc<dyn Fn() + Send + Sync> {
    Arc::new(|| ())
}
