//! A series on a real link: arming by the user, Ctrl-C as a stop, and the results. Contains no trial logic.

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, notify};
use crate::cli::session;
use crate::cli::trial::args::TrialArgs;
use crate::cli::trial::output::SeriesResult;
use crate::cli::trial::results::{ResultsRequest, TrialResults};
use crate::hand::HandSample;
use crate::link::Stop;
use crate::link::{ArmRequest, Clock, Lease, LinkHandle, Owner, Records};
use crate::motion::drive::{self, Armed, Driven, stop_words};
use crate::motion::program::{Program, Progress};
use crate::motion::series::{self, SeriesProgram};
use crate::record::Abort;
use crate::record::Record;
use crate::shell::interrupt::Interrupt;
use crate::transport::Endpoint;
use crate::trials::{TrialPlan, TrialSeries};
use anyhow::bail;
use futures::{Stream, StreamExt as _, stream};
use std::time::Duration;
use tokio::time::{Instant, sleep, timeout};

/// Interval of time checks while nothing is read.
const TICK: Duration = Duration::from_millis(5);
/// Maximum time for the hand to report its state, and to acknowledge its limits.
const READY_TIMEOUT: Duration = Duration::from_secs(5);

/// Runs the plan on the hand.
pub(crate) async fn drive(
    out: &mut Out,
    args: &TrialArgs,
    plan: &TrialPlan,
) -> anyhow::Result<SeriesResult> {
    let wanted = ResultsRequest {
        hand: args.series.own_hand(),
        json: args.series.json,
        folder: args.series.out.as_deref(),
        criterion: args.criterion(),
    };
    let mut hand = ArmedHand::ready(&args.series.hand, series::arm_limits(plan)).await?;
    let mut results = hand.results(out, wanted, plan).await?;
    let series = TrialSeries::start(plan.clone(), hand.armed.epoch, hand.armed.clock.now())?;
    let report = hand.run_trials(series, &mut results).await.report();
    let trials = results.close(report, None)?;
    Ok(SeriesResult::of(trials, report, args.criterion()))
}

/// A hand that the user armed on the command line.
pub(crate) struct ArmedHand {
    pub(crate) link: LinkHandle,
    pub(crate) armed: Armed,
    pub(crate) interrupt: Interrupt,
}

impl ArmedHand {
    /// Opens a link, waits for the hand, and arms it within these limits.
    pub(crate) async fn ready(endpoint: &Endpoint, limits: ArmRequest) -> anyhow::Result<Self> {
        let mut interrupt = Interrupt::listen()?;
        let clock = Clock::start();
        let (link, mut records) = session::open_with_records(endpoint, series::RATES, clock);
        let ready = tokio::select! {
            biased;
            () = interrupt.wished() => None,
            ready = make_ready(&link, &mut records, endpoint, limits) => Some(ready?),
        };
        let status = link.status();
        let (Some(epoch), Some((lease, seen))) = (status.armed, ready) else {
            // Arming may have been under way.
            let stop = stop_words(Some(link.stop().await));
            match (ready, status.disarmed) {
                (Some(_), Some(why)) => bail!("ended before anything moved: {why}{stop}"),
                _ => {
                    let words = format!("ended by the user before anything moved{stop}");
                    return Err(FailureKind::Interrupted.error(words));
                }
            }
        };
        Ok(Self {
            link,
            armed: Armed {
                epoch,
                lease,
                seen,
                clock,
            },
            interrupt,
        })
    }

    /// Destination of the trials. The folder is created only now: a missing hand leaves nothing behind.
    pub(crate) async fn results<'a>(
        &self,
        out: &'a mut Out,
        wanted: ResultsRequest<'_>,
        plan: &TrialPlan,
    ) -> anyhow::Result<TrialResults<'a>> {
        match TrialResults::start(out, wanted, plan, &self.link) {
            Ok(results) => Ok(results),
            Err(error) => {
                self.link.disarm();
                sleep(TICK).await;
                Err(error)
            }
        }
    }

    /// Runs a series of trials to its end, as [`Self::run`] does.
    pub(crate) async fn run_trials(
        &mut self,
        series: TrialSeries,
        results: &mut TrialResults<'_>,
    ) -> Driven<SeriesProgram> {
        let ends = by_user(&mut self.interrupt);
        let report = |step| results.apply(step);
        let driven = series::trials(&self.link, self.armed, series, ends, report).await;
        self.release(driven.stop).await;
        driven
    }

    /// Runs a program to its end, reports an unconfirmed stop, and waits until the hand is disarmed. `report` is as for
    /// [`drive`](drive::drive).
    pub(crate) async fn run<P: Program<Input = Abort>>(
        &mut self,
        program: P,
        report: impl FnMut(Progress<P::View, P::Event>) -> bool,
    ) -> Driven<P> {
        let ends = by_user(&mut self.interrupt);
        let driven = drive::drive(&self.link, self.armed, program, ends, report).await;
        self.release(driven.stop).await;
        driven
    }

    /// Reports an unconfirmed stop, and waits until the hand is disarmed.
    pub(crate) async fn release(&self, stop: Option<Stop>) {
        if stop == Some(Stop::NotConfirmed) {
            notify(session::NOT_CONFIRMED);
        }
        self.disarm().await;
    }

    /// Disarms, and waits until the link has done so.
    pub(crate) async fn disarm(&self) {
        self.link.disarm();
        let until = Instant::now() + READY_TIMEOUT;
        while self.link.status().armed.is_some() && Instant::now() < until {
            sleep(TICK).await;
        }
    }
}

/// Ends a program when the user interrupts it.
pub(crate) fn by_user(interrupt: &mut Interrupt) -> impl Stream<Item = Abort> {
    let once = stream::once(async {
        interrupt.wished().await;
        Abort::Person
    });
    once.chain(stream::pending())
}

/// Waits until the hand has reported its position, and arms it as the user requested.
async fn make_ready(
    link: &LinkHandle,
    records: &mut Records,
    endpoint: &Endpoint,
    limits: ArmRequest,
) -> anyhow::Result<(Lease, HandSample)> {
    session::answered(link, endpoint).await?;
    let mut seen = HandSample::default();
    let until = Instant::now() + READY_TIMEOUT;
    let known = |sample: &HandSample| {
        sample.faults.is_some() && sample.angle.is_some() && sample.temperature.is_some()
    };
    while !known(&seen) {
        next_record(records, &mut seen).await?;
        if Instant::now() >= until {
            bail!("the hand at {endpoint} does not report its angles, faults and temperatures");
        }
    }
    let lease = link.grant(Owner::Task);
    if let Err(why) = link.arm(lease, limits)?.await {
        // A lost link or a stop is more informative than a dropped arming.
        link.check(lease)?;
        bail!("the hand cannot be armed: {why}");
    }
    while let Some(record) = records.try_next() {
        if let Record::Reading { sample, .. } = record {
            seen = *sample;
        }
    }
    Ok((lease, seen))
}

/// Receives the next record, or waits for a tick.
async fn next_record(records: &mut Records, seen: &mut HandSample) -> anyhow::Result<()> {
    match timeout(TICK, records.next()).await {
        Ok(Some(Record::Reading { sample, .. })) => *seen = *sample,
        Ok(None) => bail!("the link ended"),
        Ok(Some(_)) | Err(_) => {}
    }
    Ok(())
}
