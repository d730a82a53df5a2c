//! `trial`: grasp trials from the command line, on any hand. It moves the hand, so it requires `--arm`.

pub(crate) mod args;
pub(crate) mod drive;
pub(crate) mod output;
pub(crate) mod overshoot;
pub(crate) mod results;

pub(crate) use args::TrialArgs;

use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, WrongUsage};
use crate::motion::drive::stop_words;
use anyhow::bail;

/// Runs the series. Fails if it ended early, or if no setting meets the criterion.
pub(crate) async fn run(out: &mut Out, args: &TrialArgs) -> anyhow::Result<()> {
    args.series.check_joints()?;
    let plan = args.plan();
    plan.check()
        .map_err(|error| WrongUsage::error(error.to_string()))?;
    if !args.series.arm {
        return Err(FailureKind::NotArmed.error(format!(
            "nothing was moved: these trials close {} on the hand at {}; when nothing but the object is in the way, add --arm",
            output::joints(&plan),
            args.series.hand
        )));
    }
    let outcome = drive::drive(out, args, &plan).await?;
    out.result(args.series.json, &outcome.json(args), outcome.lines())?;
    out.flush()?;
    if let Some(why) = outcome.aborted_words() {
        bail!("{why}{}", stop_words(outcome.report.stop));
    }
    if let Some(why) = outcome.nothing_words() {
        bail!(why);
    }
    if let Some(criterion) = outcome.criterion.filter(|_| outcome.best.is_none()) {
        bail!("no setting that was tried qualifies: {criterion}");
    }
    Ok(())
}
