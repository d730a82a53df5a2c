//! `trial`: grasp trials from the command line, on any hand. Moves the hand, so it asks for a person's word.

mod args;
mod drive;
mod told;

pub(crate) use args::TrialArgs;

use crate::app::trial::best::{best, scores};
use crate::app::trial::{Criterion, Series, Trial, TrialPlan};
use crate::cli::args::Cli;
use crate::cli::out::Out;
use crate::cli::session;
use crate::hand::Moment;
use crate::link::ArmEpoch;
use anyhow::bail;
use clap::CommandFactory as _;
use clap::error::ErrorKind;

/// What became of a series.
pub(crate) struct Outcome {
    pub(crate) trials: Vec<Trial>,
    /// Why it ended early, in words.
    pub(crate) aborted: Option<String>,
    /// What feedback says of the stop that followed, if one did.
    pub(crate) stop: Option<Stop>,
}

/// What feedback says after a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stop {
    /// The hand rests, so many seconds after the stop.
    Confirmed {
        /// Seconds.
        after_s: f64,
    },
    /// It does not show rest.
    NotConfirmed,
    /// The link is gone.
    LinkLost,
}

/// Runs the series. Fails if it ended early, or if no setting is what was wanted.
pub(crate) fn run(out: &mut Out, args: &TrialArgs) -> anyhow::Result<()> {
    let plan = plan(args);
    if !args.arm {
        bail!(
            "nothing was moved: these trials close {} on the hand at {}; when nothing but the object is in their way, say so with --arm",
            told::joints(&plan),
            args.hand
        );
    }
    let criterion = args.criterion();
    let outcome = session::runtime()?.block_on(drive::drive(out, args, &plan))?;
    let scores = scores(&outcome.trials);
    let found = criterion.map(|criterion| (criterion, best(&scores, criterion)));
    if args.json {
        let session = told::session_json(args, &outcome, &scores, found);
        out.line(&session.to_string())?;
    } else {
        told::session_text(out, &outcome, &scores, found)?;
    }
    out.flush()?;
    if let Some(why) = &outcome.aborted {
        bail!("{why}{}", told::stop_words(outcome.stop));
    }
    if let Some((criterion, None)) = found {
        bail!("no setting that was tried will do: {}", words(criterion));
    }
    Ok(())
}

fn words(criterion: Criterion) -> String {
    crate::app::trial::report::criterion_words(criterion)
}

/// The plan that is asked for. One that makes no sense is wrong usage, and ends the process as such.
fn plan(args: &TrialArgs) -> TrialPlan {
    let plan = args.plan();
    let checked = Series::start(plan.clone(), ArmEpoch::default(), Moment::ZERO);
    if let Err(error) = checked {
        Cli::command()
            .error(ErrorKind::ValueValidation, error)
            .exit();
    }
    plan
}
