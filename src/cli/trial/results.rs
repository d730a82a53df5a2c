//! Results of trials: printed, and written to files if requested. Files are written on a separate thread: a slow disk must not
//! delay the hand's feedback.

use crate::app::files::settings_file;
use crate::cli::out::{Out, notify};
use crate::cli::session;
use crate::cli::trial::output::{trial_json, trial_lines};
use crate::hand::PerDof;
use crate::hand::overshoot::OvershootMap;
use crate::link::LinkHandle;
use crate::link::quirks::book;
use crate::motion::drive::EndReport;
use crate::motion::program::Progress;
use crate::motion::series::{SeriesEvent, SeriesProgress};
use crate::store::calendar::{day, since_1970};
use crate::transport::Endpoint;
use crate::trials::overshoot_file::{self, MeasuredClose, closes_of};
use crate::trials::session::SessionHead;
use crate::trials::session_writer::TrialSessionWriter;
use crate::trials::{Criterion, EarlyEnd, Trial, TrialPlan, TrialSummary};
use anyhow::{Context as _, anyhow};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::thread::JoinHandle;

/// Capacity of the queue of trials to write.
const WAITING_MAX: usize = 16;

/// Destination of the results, and their hand.
#[derive(Clone, Copy)]
pub(crate) struct ResultsRequest<'a> {
    pub(crate) hand: &'a Endpoint,
    pub(crate) json: bool,
    pub(crate) folder: Option<&'a Path>,
    /// Criterion by which the report names the best setting.
    pub(crate) criterion: Option<Criterion>,
}

/// Receives each trial as it ends.
pub(crate) struct TrialResults<'a> {
    out: &'a mut Out,
    json: bool,
    writer: Option<WritingThread>,
    trials: Vec<TrialSummary>,
    /// Overshoot file of the hand, extended by threads that may wait.
    map: Option<PathBuf>,
    adding: Vec<JoinHandle<io::Result<OvershootMap>>>,
    total: usize,
    /// Newtons of a gram of each joint, where they are known.
    newtons_per_g: PerDof<Option<f64>>,
    /// First error of printing or writing.
    error: Option<anyhow::Error>,
}

/// Sender to the writing thread, and the thread.
type WritingThread = (
    mpsc::SyncSender<Trial>,
    JoinHandle<io::Result<TrialSessionWriter>>,
);

impl<'a> TrialResults<'a> {
    /// Creates the folder, if one was given.
    pub(crate) fn start(
        out: &'a mut Out,
        wanted: ResultsRequest<'_>,
        plan: &TrialPlan,
        link: &LinkHandle,
    ) -> anyhow::Result<Self> {
        let now = since_1970();
        let hand = wanted.hand;
        let head = || SessionHead {
            hand: hand.to_string(),
            simulated: hand.is_sim(),
            quirks: Some(book::sheet(hand, &link.status().quirks, &day(now))),
            ..SessionHead::begin(plan.clone(), now)
        };
        let started = |folder: &Path| {
            let writer = TrialSessionWriter::create(folder, head(), wanted.criterion);
            let writer =
                writer.with_context(|| format!("cannot store the trials in {}", folder.display()));
            writer.map(write_on_thread)
        };
        Ok(Self {
            out,
            json: wanted.json,
            writer: wanted.folder.map(started).transpose()?,
            trials: Vec::new(),
            map: settings_file::default_path()
                .and_then(|settings| overshoot_file::file_of(&settings, hand)),
            adding: Vec::new(),
            total: 0,
            newtons_per_g: session::newtons_per_g(hand),
            error: None,
        })
    }

    /// Handles a step of the series; returns false if it cannot be printed or written, which ends the series.
    pub(crate) fn apply(&mut self, step: SeriesProgress) -> bool {
        if let Err(error) = self.out.flush() {
            self.error.get_or_insert(error);
            return false;
        }
        match step {
            Progress::View(view) => self.total = view.total,
            Progress::Event(SeriesEvent::Search(_)) | Progress::Sent(_) => {}
            Progress::Event(SeriesEvent::Trial(trial)) => {
                if let Err(error) = self.add(*trial) {
                    self.error.get_or_insert(error);
                    return false;
                }
            }
        }
        true
    }

    fn add(&mut self, mut trial: Trial) -> anyhow::Result<()> {
        if self.writer.is_some() {
            trial.summary.samples = Some(trial.summary.samples_file());
        }
        let summary = trial.summary.clone();
        self.keep(closes_of(&trial));
        let written = self.writer.as_ref().map_or(Ok(()), |(to, _)| {
            to.try_send(trial).map_err(|_gone| {
                anyhow!("the trials cannot be written as fast as they come, or at all")
            })
        });
        let lines = trial_lines(&summary, self.total, &self.newtons_per_g);
        let json = trial_json(&summary, &self.newtons_per_g);
        let shown = self.out.result(self.json, &json, lines);
        self.trials.push(summary);
        shown.and_then(|()| self.out.flush()).and(written)
    }

    /// Adds the measurements of a trial to the overshoot file.
    fn keep(&mut self, closes: Vec<MeasuredClose>) {
        if let Some(file) = self.map.clone().filter(|_| !closes.is_empty()) {
            let add = move || overshoot_file::add(&file, &closes, &day(since_1970()));
            self.adding.push(std::thread::spawn(add));
        }
    }

    /// Waits until all is written, and returns the trials. `note` is the result for the session file.
    pub(crate) fn close(
        self,
        report: EndReport,
        note: Option<(&str, toml::Table)>,
    ) -> anyhow::Result<Vec<TrialSummary>> {
        for added in self.adding {
            let file = self.map.as_deref().unwrap_or(Path::new(""));
            if let Ok(Err(error)) = added.join() {
                notify(&format!(
                    "warning: the measurements of this hand are not stored in {}: {error}",
                    file.display()
                ));
            }
        }
        let written = self.writer.map_or(Ok(()), |(trials, thread)| {
            drop(trials);
            let ended = thread.join();
            let writer = ended.map_err(|_panic| anyhow!("writing the trials failed"))?;
            let finished = writer.and_then(|mut writer| {
                if let Some((key, table)) = note {
                    writer.note(key, table);
                }
                writer.finish(report.aborted.map(EarlyEnd::Here))
            });
            finished.context("cannot write the trials")
        });
        match self.error {
            Some(error) => Err(session::unread(error, report.stop)),
            None => written.map(|()| self.trials),
        }
    }
}

fn write_on_thread(mut writer: TrialSessionWriter) -> WritingThread {
    let (trials, waiting) = mpsc::sync_channel::<Trial>(WAITING_MAX);
    let thread = std::thread::spawn(move || {
        for trial in waiting {
            writer.add(&trial.summary, &trial.recording)?;
        }
        Ok(writer)
    });
    (trials, thread)
}
