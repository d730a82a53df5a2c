//! Trials and check-ups on a hand that the user armed, as programs.

use crate::checkup::Checkup;
use crate::checkup::run::CheckupView;
use crate::hand::{Force, Groups, HandSample, Moment, PerDof, Speed};
use crate::link::{ArmRequest, LinkHandle, PollRates};
use crate::motion::drive::{Armed, Driven, drive};
use crate::motion::program::{Ended, Order, Program, Progress, Seen};
use crate::record::Abort;
use crate::trials::limits::TaskStall;
use crate::trials::plan::TrialPlan;
use crate::trials::search::SearchProgress;
use crate::trials::series::{SeriesView, TrialSeries};
use crate::trials::summary::Trial;
use futures::Stream;
use std::convert::Infallible;

/// Poll rates of a series. A line that cannot reach them is read as fast as it can be.
pub const RATES: PollRates = PollRates {
    state_hz: 500.0,
    tactile_hz: 60.0,
    settings_hz: 5.0,
};

/// Event of a series.
#[derive(Debug, Clone, PartialEq)]
pub enum SeriesEvent {
    /// A trial ended.
    Trial(Box<Trial>),
    /// Progress of a search: at its start, and after each trial.
    Search(Box<SearchProgress>),
}

/// Progress of a series.
pub type SeriesProgress = Progress<SeriesView, SeriesEvent>;

/// Runs a series of trials to its end. `report` returns false if it could not store or show the progress; the series then ends. At the
/// end the hand is disarmed.
pub async fn trials(
    hand: &LinkHandle,
    armed: Armed,
    series: TrialSeries,
    ends: impl Stream<Item = Abort>,
    report: impl FnMut(SeriesProgress) -> bool,
) -> Driven<SeriesProgram> {
    drive(hand, armed, SeriesProgram::new(series), ends, report).await
}

/// A series of trials as a program.
#[derive(Debug)]
pub struct SeriesProgram {
    /// The series, with its results.
    pub series: TrialSeries,
    /// The progress of a search was not reported since its start or its last trial.
    is_search_due: bool,
}

impl SeriesProgram {
    /// A series that begins with the first step of the program.
    pub const fn new(series: TrialSeries) -> Self {
        Self {
            series,
            is_search_due: true,
        }
    }
}

impl Program for SeriesProgram {
    type Input = Abort;
    type Outcome = ();
    type View = SeriesView;
    type Event = SeriesEvent;
    const RATES: Option<PollRates> = Some(RATES);

    fn input(&mut self, why: Abort, seen: &Seen<'_>) -> Option<Order> {
        self.series.abort(why, seen.now);
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, _now: Moment) {
        self.series.read(sample, fresh);
    }

    fn stalled(&mut self, stall: TaskStall) {
        self.series.stalled(stall);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let set = self.series.tick(seen.sample, seen.stall, seen.now);
        let is_done = self.series.is_over() && self.series.aborted().is_none();
        set.map(Order::Set).or(is_done.then_some(Order::Disarm))
    }

    fn abort(&mut self, why: Abort, now: Moment) {
        self.series.abort(why, now);
    }

    fn view(&self, _now: Moment) -> SeriesView {
        self.series.view()
    }

    fn event(&mut self) -> Option<SeriesEvent> {
        if std::mem::take(&mut self.is_search_due)
            && let Some(search) = self.series.settings_search()
        {
            return Some(SeriesEvent::Search(Box::new(search.progress())));
        }
        let trial = self.series.finished()?;
        self.is_search_due = true;
        Some(SeriesEvent::Trial(Box::new(trial)))
    }

    fn ended(&self) -> Option<Ended<()>> {
        let aborted = self.series.aborted();
        self.series.is_over().then(|| aborted.map_or(Ok(()), Err))
    }
}

impl Program for Checkup {
    type Input = Abort;
    type Outcome = ();
    type View = CheckupView;
    type Event = Infallible;
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

    fn view(&self, _now: Moment) -> CheckupView {
        Self::view(self)
    }

    fn ended(&self) -> Option<Ended<()>> {
        self.is_over().then(|| self.aborted().map_or(Ok(()), Err))
    }
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
