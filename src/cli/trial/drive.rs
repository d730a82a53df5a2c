//! A series on a real link: the person's word to arm, Ctrl-C as a stop, and the trials as they end. Decides nothing about
//! trials.

use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, say};
use crate::cli::session;
use crate::cli::trial::args::TrialArgs;
use crate::cli::trial::output;
use crate::cli::trial::output::Outcome;
use crate::cli::trial::writer::Writer;
use crate::hand::HandSample;
use crate::link::{Clock, LinkHandle, Records};
use crate::record::Record;
use crate::tasks::series::{self, SeriesStart, SeriesStep, Stop, Told};
use crate::transport::Endpoint;
use crate::trials::{Abort, Trial, TrialPlan, TrialSummary};
use anyhow::bail;
use std::time::Duration;
use tokio::time::{Instant, sleep, timeout};

/// How often the time is checked while nothing is read.
const TICK: Duration = Duration::from_millis(5);
/// How long the hand may take to report its state, and to acknowledge its limits.
const READY_WITHIN: Duration = Duration::from_secs(5);

/// Runs the plan on the hand.
pub(crate) async fn drive(
    out: &mut Out,
    args: &TrialArgs,
    plan: &TrialPlan,
) -> anyhow::Result<Outcome> {
    let mut interrupt = Interrupt::listen()?;
    let clock = Clock::start();
    let (link, mut records) = session::open_with_records(&args.hand, series::RATES, clock);
    let seen = tokio::select! {
        biased;
        () = interrupt.wished() => None,
        seen = make_ready(&link, &mut records, &args.hand, plan) => Some(seen?),
    };
    let (Some(epoch), Some(seen)) = (link.status().armed, seen) else {
        // Arming may have been under way.
        let stop = series::hold(&link, &mut records).await;
        bail!(
            "ended by a person before anything moved{}",
            output::stop_words(Some(stop))
        );
    };
    // The folder is made only now: nothing is left behind by a hand that is not there.
    let writer = match Writer::start(args, plan, &link) {
        Ok(writer) => writer,
        Err(error) => {
            link.disarm();
            sleep(TICK).await;
            return Err(error);
        }
    };
    let start = SeriesStart {
        plan: plan.clone(),
        epoch,
        turn: link.take_turn(),
        seen,
        clock,
    };
    let mut finished = Finished::new(out, args.json, writer);
    let ended = async {
        interrupt.wished().await;
        Abort::Person
    };
    let report = series::series(&link, start, ended, |step| finished.take(step)).await?;
    if report.stop == Some(Stop::NotConfirmed) {
        say("STOP NOT CONFIRMED: the hand may still move; switch off its 24 V supply");
    }
    disarm(&link).await;
    let trials = finished.close(report.aborted)?;
    Ok(Outcome::of(trials, report, args.criterion()))
}

/// The trials that are over: shown, and written where that is asked.
struct Finished<'a> {
    out: &'a mut Out,
    json: bool,
    writer: Option<Writer>,
    trials: Vec<TrialSummary>,
    total: usize,
    /// What could not be shown or written first.
    error: Option<anyhow::Error>,
}

impl<'a> Finished<'a> {
    const fn new(out: &'a mut Out, json: bool, writer: Option<Writer>) -> Self {
        Self {
            out,
            json,
            writer,
            trials: Vec::new(),
            total: 0,
            error: None,
        }
    }

    fn take(&mut self, step: SeriesStep) -> Told {
        match step {
            SeriesStep::View(view) => self.total = view.total,
            SeriesStep::Mark(_) => {}
            SeriesStep::Trial(trial) => {
                if let Err(error) = self.add(*trial) {
                    self.error.get_or_insert(error);
                    return Told::Lost;
                }
            }
        }
        Told::Kept
    }

    fn add(&mut self, mut trial: Trial) -> anyhow::Result<()> {
        if self.writer.is_some() {
            trial.summary.samples = Some(trial.summary.samples_file());
        }
        self.trials.push(trial.summary.clone());
        let shown = self.show(&trial.summary);
        let written = self.writer.as_ref().map_or(Ok(()), |to| to.write(trial));
        shown.and(written)
    }

    fn show(&mut self, trial: &TrialSummary) -> anyhow::Result<()> {
        let lines = output::trial_lines(trial, self.total);
        self.out
            .result(self.json, &output::trial_json(trial), lines)?;
        self.out.flush()
    }

    fn close(self, aborted: Option<Abort>) -> anyhow::Result<Vec<TrialSummary>> {
        let written = self.writer.map_or(Ok(()), |writer| writer.finish(aborted));
        match self.error {
            Some(error) => Err(error),
            None => written.map(|()| self.trials),
        }
    }
}

/// Disarms, and waits until the link has done so.
async fn disarm(link: &LinkHandle) {
    link.disarm();
    let until = Instant::now() + READY_WITHIN;
    while link.status().armed.is_some() && Instant::now() < until {
        sleep(TICK).await;
    }
}

/// Waits until the hand tells where it is, and arms it as the person asked for.
async fn make_ready(
    link: &LinkHandle,
    records: &mut Records,
    endpoint: &Endpoint,
    plan: &TrialPlan,
) -> anyhow::Result<HandSample> {
    session::answered(link, endpoint).await?;
    let mut seen = HandSample::default();
    let until = Instant::now() + READY_WITHIN;
    let known = |sample: &HandSample| {
        sample.faults.is_some() && sample.angle.is_some() && sample.temperature.is_some()
    };
    while !known(&seen) {
        take_news(records, &mut seen).await?;
        if Instant::now() >= until {
            bail!("the hand at {endpoint} does not tell its angles, faults and temperatures");
        }
    }
    link.arm(series::arm_limits(plan));
    while link.status().armed.is_none() {
        take_news(records, &mut seen).await?;
        if Instant::now() >= until {
            bail!("the hand at {endpoint} could not be armed in time");
        }
    }
    Ok(seen)
}

/// Takes the next record, or lets a moment pass.
async fn take_news(records: &mut Records, seen: &mut HandSample) -> anyhow::Result<()> {
    match timeout(TICK, records.next()).await {
        Ok(Some(Record::Reading { sample, .. })) => *seen = *sample,
        Ok(Some(Record::ArmRefused { reason, .. })) => bail!("the hand cannot be armed: {reason}"),
        Ok(None) => bail!("the link ended"),
        Ok(Some(_)) | Err(_) => {}
    }
    Ok(())
}
