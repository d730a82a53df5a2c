//! The files of a series, written on a thread of their own: a slow disk must not make the hand's feedback old.

use crate::cli::trial::args::TrialArgs;
use crate::link::LinkHandle;
use crate::link::quirks::book;
use crate::store::calendar::{day, since_1970};
use crate::trials::session::SessionHead;
use crate::trials::session::writer::SessionWriter;
use crate::trials::{Abort, EarlyEnd, Trial, TrialPlan};
use anyhow::{Context as _, anyhow};
use std::io;
use std::sync::mpsc;
use std::thread::JoinHandle;

/// Trials that wait to be written while the next runs.
const WAITING_MAX: usize = 16;

/// Writes trials as they come.
pub(crate) struct Writer {
    trials: mpsc::SyncSender<Trial>,
    thread: JoinHandle<io::Result<SessionWriter>>,
}

impl Writer {
    /// Creates the folder, if one was given.
    pub(crate) fn start(
        args: &TrialArgs,
        plan: &TrialPlan,
        link: &LinkHandle,
    ) -> anyhow::Result<Option<Self>> {
        let Some(folder) = &args.out else {
            return Ok(None);
        };
        let now = since_1970();
        let head = SessionHead {
            hand: args.hand.to_string(),
            simulated: args.hand.is_sim(),
            quirks: Some(book::sheet(&args.hand, &link.status().quirks, &day(now))),
            ..SessionHead::begin(plan.clone(), now)
        };
        let mut writer = SessionWriter::create(folder, head, args.criterion())
            .with_context(|| format!("cannot store the trials in {}", folder.display()))?;
        let (trials, waiting) = mpsc::sync_channel::<Trial>(WAITING_MAX);
        let thread = std::thread::spawn(move || {
            for trial in waiting {
                writer.add(&trial.summary, &trial.recording)?;
            }
            Ok(writer)
        });
        Ok(Some(Self { trials, thread }))
    }

    /// Takes a trial to be written.
    pub(crate) fn write(&self, trial: Trial) -> anyhow::Result<()> {
        self.trials.try_send(trial).map_err(|_gone| {
            anyhow!("the trials cannot be written as fast as they come, or at all")
        })
    }

    /// Waits until all is written, and says how it ended.
    pub(crate) fn finish(self, aborted: Option<Abort>) -> anyhow::Result<()> {
        drop(self.trials);
        let ended = self.thread.join();
        let writer = ended.map_err(|_panic| anyhow!("writing the trials failed"))?;
        let aborted = aborted.map(EarlyEnd::Here);
        let finished = writer.and_then(|writer| writer.finish(aborted));
        finished.context("cannot write the trials")
    }
}
