//! The search for the fastest close under a limit, on a hand that a person armed: a series of trials like any other, of which each
//! is chosen from those before. Decides nothing about trials.

use crate::hand::{ArmEpoch, HandSample};
use crate::link::{Clock, Lease};
use crate::tasks::hand::TaskHand;
use crate::tasks::series::{BegunSeries, SeriesReport, SeriesStep, run};
use crate::trials::find::{FindProgress, Finder, Finding, Tried};
use crate::trials::limits::Abort;
use crate::trials::series::TrialSeries;

/// What is told on the way.
#[derive(Debug, Clone, PartialEq)]
pub enum TuneStep {
    /// As of any series: the stage, or a trial that is over.
    Series(SeriesStep),
    /// What the search makes of the trials so far; after each, and once at the start.
    Progress(Box<FindProgress>),
}

/// What a search begins with.
#[derive(Debug, Clone)]
pub struct TuneStart {
    /// The search, whose wish was checked.
    pub finder: Finder,
    /// The arming that a person gave for it.
    pub epoch: ArmEpoch,
    /// The right to move the hand.
    pub lease: Lease,
    /// What was read until now.
    pub seen: HandSample,
    /// The program's clock.
    pub clock: Clock,
}

/// How a search ended.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneReport {
    /// How its series ended.
    pub series: SeriesReport,
    /// What it came to; `None` if it was ended early.
    pub finding: Option<Finding>,
    /// Every close that was tried, also of a search that was ended early.
    pub tried: Vec<Tried>,
}

/// Searches. `tell` says whether it could keep what it was told; else the search ends. `ended` resolves when a person ends it. At
/// the end the hand is not armed any more.
pub async fn tune<H: TaskHand>(
    hand: &H,
    start: TuneStart,
    ended: impl Future<Output = Abort>,
    mut tell: impl FnMut(TuneStep) -> bool,
) -> TuneReport {
    let first = Box::new(start.finder.progress());
    let is_kept = tell(TuneStep::Progress(first));
    let mut series = TrialSeries::search(start.finder, start.epoch, start.clock.now());
    if !is_kept {
        let _nothing_moves_yet = series.end(Abort::NotKept, start.clock.now());
    }
    let begun = BegunSeries {
        series,
        lease: start.lease,
        seen: start.seen,
        clock: start.clock,
    };
    let (series, report) = run(hand, begun, ended, |series, step| {
        let is_trial = matches!(step, SeriesStep::Trial(_));
        let is_kept = tell(TuneStep::Series(step));
        let progress = series.finder().filter(|_| is_trial).map(Finder::progress);
        progress.is_none_or(|progress| tell(TuneStep::Progress(Box::new(progress)))) && is_kept
    })
    .await;
    let finder = series.finder();
    TuneReport {
        series: report,
        finding: finder.and_then(Finder::finding),
        tried: finder.map(|own| own.tried().to_vec()).unwrap_or_default(),
    }
}
