//! Trials and check-ups on a hand that the user armed, as programs.

use crate::checkup::Checkup;
use crate::hand::{Force, Groups, HandSample, Moment, PerDof, Speed};
use crate::link::{ArmRequest, LinkHandle, PollRates};
use crate::motion::drive::{Armed, Driven, drive};
use crate::motion::program::{Ended, Order, Program, Seen};
use crate::record::Abort;
use crate::trials::limits::TaskStall;
use crate::trials::plan::TrialPlan;
use crate::trials::search::{SearchProgress, SettingsSearch};
use crate::trials::series::{SeriesView, TrialSeries};
use crate::trials::summary::Trial;
use futures::Stream;

/// Poll rates of a series. A line that cannot reach them is read as fast as it can be.
pub const RATES: PollRates = PollRates {
    state_hz: 500.0,
    tactile_hz: 60.0,
    settings_hz: 5.0,
};

/// Progress of a series.
#[derive(Debug, Clone, PartialEq)]
pub enum SeriesStep {
    /// The stage or the trial changed.
    View(SeriesView),
    /// A trial ended.
    Trial(Box<Trial>),
    /// Progress of a search: at its start, and after each trial.
    Search(Box<SearchProgress>),
}

/// Runs a series of trials to its end. `report` returns false if it could not store or show the step; the series then ends. At the end
/// the hand is disarmed.
pub async fn trials(
    hand: &LinkHandle,
    armed: Armed,
    mut series: TrialSeries,
    ends: impl Stream<Item = Abort>,
    mut report: impl FnMut(SeriesStep) -> bool,
) -> Driven<TrialSeries> {
    if !report_search(&series, &mut report) {
        series.abort(Abort::NotKept, armed.clock.now());
    }
    let mut shown = None;
    drive(hand, armed, series, ends, |series, _| {
        report_news(series, &mut shown, &mut report)
    })
    .await
}

impl Program for TrialSeries {
    type Input = Abort;
    type Outcome = ();
    const RATES: Option<PollRates> = Some(RATES);

    fn input(&mut self, why: Abort, seen: &Seen<'_>) -> Option<Order> {
        Self::abort(self, why, seen.now);
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, _now: Moment) {
        Self::read(self, sample, fresh);
    }

    fn stalled(&mut self, stall: TaskStall) {
        Self::stalled(self, stall);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let set = Self::tick(self, seen.sample, seen.stall, seen.now);
        let is_done = self.is_over() && self.aborted().is_none();
        set.map(Order::Set).or(is_done.then_some(Order::Disarm))
    }

    fn abort(&mut self, why: Abort, now: Moment) {
        Self::abort(self, why, now);
    }

    fn ended(&self) -> Option<Ended<()>> {
        self.is_over().then(|| self.aborted().map_or(Ok(()), Err))
    }
}

impl Program for Checkup {
    type Input = Abort;
    type Outcome = ();
    const RATES: Option<PollRates> = Some(RATES);

    fn input(&mut self, why: Abort, _seen: &Seen<'_>) -> Option<Order> {
        Self::abort(self, why);
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, _now: Moment) {
        Self::read(self, sample, fresh);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let was_pressing = self.is_pressing();
        let set = Self::tick(self, seen.sample, seen.stall, seen.now);
        // The user touches a fingertip only while the hand cannot move.
        let disarms = self.is_pressing() && !was_pressing;
        let is_done = self.is_over() && self.aborted().is_none();
        set.map(Order::Set)
            .or((disarms || is_done).then_some(Order::Disarm))
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        Self::abort(self, why);
    }

    fn ended(&self) -> Option<Ended<()>> {
        self.is_over().then(|| self.aborted().map_or(Ok(()), Err))
    }
}

/// Reports ended trials and the state of the series. False if a step could not be stored or shown.
fn report_news(
    series: &mut TrialSeries,
    shown: &mut Option<SeriesView>,
    report: &mut impl FnMut(SeriesStep) -> bool,
) -> bool {
    let mut is_kept = true;
    while let Some(trial) = series.finished() {
        is_kept &= report(SeriesStep::Trial(Box::new(trial)));
        is_kept &= report_search(series, report);
    }
    let view = series.view();
    if shown.replace(view) != Some(view) {
        is_kept &= report(SeriesStep::View(view));
    }
    is_kept
}

/// Reports the progress of a search; true for a series that is not a search.
fn report_search(series: &TrialSeries, report: &mut impl FnMut(SeriesStep) -> bool) -> bool {
    let progress = series.settings_search().map(SettingsSearch::progress);
    progress.is_none_or(|progress| report(SeriesStep::Search(Box::new(progress))))
}

/// Limits to arm with for a plan: gentle, and no stronger than its smallest threshold.
pub fn arm_limits(plan: &TrialPlan) -> ArmRequest {
    let least = plan.grid.forces.iter().min().copied();
    let force = least.map_or(Force::GENTLE, |least| least.min(Force::GENTLE));
    ArmRequest {
        speed: PerDof::splat(Speed::GENTLE),
        force: PerDof::splat(force),
    }
}
