//! A series on a real link: the user's word to arm, Ctrl-C as a stop, and the trials as they end. Decides nothing about
//! trials.

use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, say};
use crate::cli::session;
use crate::cli::trial::args::TrialArgs;
use crate::cli::trial::output;
use crate::cli::trial::output::Outcome;
use crate::cli::trial::results::TrialResults;
use crate::hand::HandSample;
use crate::link::{Clock, Lease, LinkHandle, Owner, Records};
use crate::record::Record;
use crate::tasks::series::{self, SeriesStart, Stop};
use crate::transport::Endpoint;
use crate::trials::{Abort, TrialPlan};
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
    let ready = tokio::select! {
        biased;
        () = interrupt.wished() => None,
        ready = make_ready(&link, &mut records, &args.hand, plan) => Some(ready?),
    };
    let (Some(epoch), Some((lease, seen))) = (link.status().armed, ready) else {
        // Arming may have been under way.
        let stop = series::hold(&link, &mut records).await;
        bail!(
            "ended by a person before anything moved{}",
            output::stop_words(Some(stop))
        );
    };
    // The folder is made only now: nothing is left behind by a hand that is not there.
    let mut results = match TrialResults::start(out, args, plan, &link) {
        Ok(results) => results,
        Err(error) => {
            link.disarm();
            sleep(TICK).await;
            return Err(error);
        }
    };
    let start = SeriesStart {
        plan: plan.clone(),
        epoch,
        lease,
        seen,
        clock,
    };
    let ended = async {
        interrupt.wished().await;
        Abort::Person
    };
    let report = series::series(&link, start, ended, |step| results.take(step)).await?;
    if report.stop == Some(Stop::NotConfirmed) {
        say(session::NOT_CONFIRMED);
    }
    disarm(&link).await;
    let trials = results.close(report.aborted)?;
    Ok(Outcome::of(trials, report, args.criterion()))
}

/// Disarms, and waits until the link has done so.
async fn disarm(link: &LinkHandle) {
    link.disarm();
    let until = Instant::now() + READY_WITHIN;
    while link.status().armed.is_some() && Instant::now() < until {
        sleep(TICK).await;
    }
}

/// Waits until the hand tells where it is, and arms it as the user asked for.
async fn make_ready(
    link: &LinkHandle,
    records: &mut Records,
    endpoint: &Endpoint,
    plan: &TrialPlan,
) -> anyhow::Result<(Lease, HandSample)> {
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
    let lease = link.grant(Owner::Task);
    link.arm(lease, series::arm_limits(plan))?;
    while link.status().armed.is_none() {
        take_news(records, &mut seen).await?;
        if Instant::now() >= until {
            bail!("the hand at {endpoint} could not be armed in time");
        }
    }
    Ok((lease, seen))
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
