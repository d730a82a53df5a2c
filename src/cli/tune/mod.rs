//! `tune`: finds the fastest close whose peak stays under a limit, on any hand. It moves the hand, so it requires `--arm`.

mod args;
mod output;

pub(crate) use args::TuneArgs;

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, WrongUsage};
use crate::cli::session;
use crate::cli::trial::drive::ArmedHand;
use crate::cli::trial::output::joints;
use crate::cli::trial::results::ResultsRequest;
use crate::cli::tune::output::SearchReport;
use crate::motion::series;
use crate::trials::TrialSeries;
use crate::trials::search::SettingsSearch;
use anyhow::bail;

/// Runs the search. Fails if it ended early, or if there is no claim.
pub(crate) async fn run(out: &mut Out, args: &TuneArgs) -> anyhow::Result<()> {
    args.series.check_joints()?;
    let search =
        SettingsSearch::new(args.goal()).map_err(|error| WrongUsage::error(error.to_string()))?;
    if !args.series.arm {
        return Err(FailureKind::NotArmed.error(format!(
            "nothing was moved: this search closes {} on the hand at {} about 65 times; when nothing but the object is in the way, add --arm",
            joints(&search.plan()),
            args.series.hand
        )));
    }
    let report = run_search(out, args, search).await?;
    out.result(
        args.series.json,
        &output::json(args, &report),
        output::lines(&report),
    )?;
    out.flush()?;
    match output::no_claim(&report) {
        Some(why) => bail!(why),
        None => Ok(()),
    }
}

async fn run_search(
    out: &mut Out,
    args: &TuneArgs,
    search: SettingsSearch,
) -> anyhow::Result<SearchReport> {
    let plan = search.plan();
    let wanted = ResultsRequest {
        hand: args.series.own_hand(),
        json: args.series.json,
        folder: args.series.out.as_deref(),
        criterion: None,
    };
    let mut hand = ArmedHand::ready(&args.series.hand, series::arm_limits(&plan)).await?;
    let mut results = hand.results(out, wanted, &plan).await?;
    let search = TrialSeries::search(search, hand.armed.epoch, hand.armed.clock.now());
    let driven = hand.run_trials(search, &mut results).await;
    let ended = driven.report();
    let search = driven.program.series.settings_search();
    let report = SearchReport {
        series: ended,
        finding: search.and_then(SettingsSearch::finding),
        tried: search.map(|own| own.tried().to_vec()).unwrap_or_default(),
        newtons_per_g: session::newtons_per_g(args.series.own_hand()),
    };
    let note = output::table(args, &report);
    results.close(ended, Some(("tune", note)))?;
    Ok(report)
}
