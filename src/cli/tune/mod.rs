//! `tune`: finds the fastest close whose peak stays under a limit, on any hand. It moves the hand, so it requires `--arm`.

mod args;
mod output;

pub(crate) use args::TuneArgs;

use crate::cli::out::{Out, WrongUsage};
use crate::cli::trial::drive::{ArmedHand, end};
use crate::cli::trial::output::joints;
use crate::cli::trial::results::ResultsWanted;
use crate::tasks::tune::{self, TuneReport, TuneStart, TuneStep};
use crate::trials::Abort;
use crate::trials::find::Finder;
use anyhow::bail;

/// Runs the search. Fails if it ended early, or if there is nothing to claim.
pub(crate) async fn run(out: &mut Out, args: &TuneArgs) -> anyhow::Result<()> {
    let finder = Finder::new(args.wish()).map_err(|error| WrongUsage::error(error.to_string()))?;
    if !args.arm {
        bail!(
            "nothing was moved: this search closes {} on the hand at {} about twenty times; when nothing but the object is in the way, add --arm",
            joints(&finder.plan()),
            args.hand
        );
    }
    let report = search(out, args, finder).await?;
    out.result(
        args.json,
        &output::json(args, &report),
        output::lines(&report),
    )?;
    out.flush()?;
    match output::no_claim(&report) {
        Some(why) => bail!(why),
        None => Ok(()),
    }
}

async fn search(out: &mut Out, args: &TuneArgs, finder: Finder) -> anyhow::Result<TuneReport> {
    let plan = finder.plan();
    let wanted = ResultsWanted {
        hand: &args.hand,
        json: args.json,
        folder: args.out.as_deref(),
        criterion: None,
    };
    let mut hand = ArmedHand::ready(&args.hand, &plan).await?;
    let mut results = hand.results(out, wanted, &plan).await?;
    let start = TuneStart {
        finder,
        epoch: hand.epoch,
        lease: hand.lease,
        seen: hand.seen,
        clock: hand.clock,
    };
    let ended = async {
        hand.interrupt.wished().await;
        Abort::Person
    };
    let report = tune::tune(&hand.link, start, ended, |step| match step {
        TuneStep::Series(step) => results.take(step),
        TuneStep::Progress(_) => true,
    })
    .await;
    end(&hand.link, report.series).await;
    let note = output::table(args, &report);
    results.close(report.series.aborted, Some(("tune", note)))?;
    Ok(report)
}
