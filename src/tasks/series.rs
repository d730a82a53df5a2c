//! A series of grasp trials on a hand that the user armed: readings in, setpoints out, every reading judged as it comes, and
//! every stop looked after until feedback shows rest. Decides nothing about trials.

use crate::hand::{HandSample, Moment, PerDof, Speed};
use crate::link::{Clock, Lease, LinkStatus, PollRates, Stop};
use crate::record::Record;
use crate::tasks::hand::TaskHand;
use crate::trials::limits::{Abort, LinkView, Stall};
use crate::trials::plan::TrialPlan;
use crate::trials::search::{SearchProgress, SettingsSearch};
use crate::trials::series::{Series, SeriesOrder, SeriesView, TrialSeries};
use crate::trials::summary::Trial;
use std::pin::pin;
use std::time::Duration;
use tokio::time::timeout;

/// How often a series wants the hand to be read; no line is slower for it than it can be.
pub const RATES: PollRates = PollRates {
    state_hz: 500.0,
    tactile_hz: 60.0,
    settings_hz: 5.0,
};
/// How often time is looked at where nothing is read.
const TICK: Duration = Duration::from_millis(5);
/// A series that has not run for so long was kept from it: its loop runs at least once in a [`TICK`].
const STALL: Duration = Duration::from_millis(50);

/// What is told on the way.
#[derive(Debug, Clone, PartialEq)]
pub enum SeriesStep {
    /// The stage or the trial changed.
    View(SeriesView),
    /// A trial is over.
    Trial(Box<Trial>),
    /// What a search makes of its trials: at its start, and after each.
    Search(Box<SearchProgress>),
}

/// How a series ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeriesReport {
    /// Why it ended early, if it did.
    pub aborted: Option<Abort>,
    /// What feedback says of the stop that followed, if one did.
    pub stop: Option<Stop>,
}

/// What a series begins with.
#[derive(Debug, Clone)]
pub struct SeriesStart<S = TrialSeries> {
    /// The series, in the arming that the user gave for it.
    pub series: S,
    /// The right to move the hand.
    pub lease: Lease,
    /// What was read until now.
    pub seen: HandSample,
    /// The program's clock.
    pub clock: Clock,
}

/// Runs a series of trials to its end, and gives it back. `tell` says whether it could keep what it was told; else the series ends.
/// `ended` resolves when the user ends it. At the end the hand is not armed any more.
pub async fn trials<H: TaskHand>(
    hand: &H,
    mut start: SeriesStart,
    ended: impl Future<Output = Abort>,
    mut tell: impl FnMut(SeriesStep) -> bool,
) -> (TrialSeries, SeriesReport) {
    if !tell_search(&start.series, &mut tell) {
        let now = start.clock.now();
        let _nothing_moves_yet = start.series.end(Abort::NotKept, now);
    }
    let mut shown = None;
    run(hand, start, ended, |series| {
        tell_news(series, &mut shown, &mut tell)
    })
    .await
}

/// Runs what moves a hand from its readings to its end, and gives it back. `tell` sees it after each reading, and says whether it
/// could keep what is new; else it ends. `ended` resolves when the user ends it. At the end the hand is not armed any more.
pub async fn run<H: TaskHand, S: Series>(
    hand: &H,
    start: SeriesStart<S>,
    ended: impl Future<Output = Abort>,
    mut tell: impl FnMut(&mut S) -> bool,
) -> (S, SeriesReport) {
    let SeriesStart {
        mut series,
        lease,
        seen: mut sample,
        clock,
    } = start;
    let mut records = hand.records();
    hand.read_at(RATES);
    let mut ended = pin!(ended);
    let mut stop = None;
    let mut turns = Turns::from(clock.now());
    while !series.is_over() {
        let mut order = None;
        tokio::select! {
            biased;
            why = &mut ended => order = series.end(why, clock.now()),
            record = timeout(TICK, records.next()) => {
                if let Some(stall) = turns.turn(clock.now()) {
                    series.stalled(stall);
                }
                if let Ok(Some(Record::Reading { sample: newest, fresh })) = record {
                    sample = *newest;
                    series.take(&sample, fresh);
                }
                let LinkStatus { state, armed, disarmed, foreign_setpoint, .. } = hand.status();
                let link = LinkView { state, armed, disarmed, foreign_setpoint, stall: turns.stall };
                order = order.or(series.tick(&sample, link, clock.now()));
            }
        }
        if let Some(SeriesOrder::Set(setpoints)) = &order {
            // A lease that ended has disarmed too, and that ends the series.
            let _set = hand.set(lease, setpoints);
        }
        if order == Some(SeriesOrder::Disarm) {
            hand.disarm();
        }
        if !tell(&mut series) {
            order = series.end(Abort::NotKept, clock.now()).or(order);
        }
        if order == Some(SeriesOrder::Stop) {
            stop = Some(hand.stopped().await);
        }
    }
    tell(&mut series);
    hand.read_at(PollRates::default());
    if stop.is_none() {
        hand.disarm();
    }
    let aborted = series.aborted();
    (series, SeriesReport { aborted, stop })
}

/// The turns of the loop of a series: what lies between two that are far apart.
struct Turns {
    last: Moment,
    stall: Option<Stall>,
}

impl Turns {
    const fn from(now: Moment) -> Self {
        Self {
            last: now,
            stall: None,
        }
    }

    /// One more turn; the stall before it, if there was one.
    fn turn(&mut self, now: Moment) -> Option<Stall> {
        let lasted = now.since(self.last);
        self.last = now;
        let stall = (lasted > STALL).then_some(Stall { lasted, ended: now });
        self.stall = stall.or(self.stall);
        stall
    }
}

/// Tells what is new: trials that are over, and where the series stands. False if something could not be kept.
fn tell_news(
    series: &mut TrialSeries,
    shown: &mut Option<SeriesView>,
    tell: &mut impl FnMut(SeriesStep) -> bool,
) -> bool {
    let mut is_kept = true;
    while let Some(trial) = series.finished() {
        is_kept &= tell(SeriesStep::Trial(Box::new(trial)));
        is_kept &= tell_search(series, tell);
    }
    let view = series.view();
    if shown.replace(view) != Some(view) {
        is_kept &= tell(SeriesStep::View(view));
    }
    is_kept
}

/// Tells where a search stands; true of what is none.
fn tell_search(series: &TrialSeries, tell: &mut impl FnMut(SeriesStep) -> bool) -> bool {
    let progress = series.settings_search().map(SettingsSearch::progress);
    progress.is_none_or(|progress| tell(SeriesStep::Search(Box::new(progress))))
}

/// What is told where no feedback comes any more.
pub const STOP_LOST: &str =
    "the link is lost, so a stop cannot be confirmed: switch off the 24 V supply if the hand moves";

/// What feedback says of a stop that followed an early end, after its reason.
pub fn stop_words(stop: Option<Stop>) -> String {
    match stop {
        None => String::new(),
        Some(Stop::Confirmed { after }) => {
            let after_s = after.as_secs_f64();
            format!("; stopped: feedback shows rest after {after_s:.2} s")
        }
        Some(Stop::NotConfirmed) => "; the stop is not confirmed by feedback".into(),
        Some(Stop::LinkLost) => format!("; {STOP_LOST}"),
    }
}

/// The limits that a hand is armed with for a plan: gentle, and no stronger than its smallest threshold.
pub fn arm_limits(plan: &TrialPlan) -> crate::link::ArmRequest {
    use crate::hand::Force;
    let least = plan.grid.forces.iter().min().copied();
    let force = least.map_or(Force::GENTLE, |least| least.min(Force::GENTLE));
    crate::link::ArmRequest {
        speed: PerDof::splat(Speed::GENTLE),
        force: PerDof::splat(force),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_that_comes_late_is_a_stall_of_this_program() {
        let at = |ms: u64| Moment::from_micros(1000 * ms);
        let mut turns = Turns::from(at(1000));
        for ms in (1005..1100).step_by(5) {
            assert_eq!(turns.turn(at(ms)), None);
        }
        let stall = Stall {
            lasted: Duration::from_millis(405),
            ended: at(1500),
        };
        assert_eq!(turns.turn(at(1500)), Some(stall));
        assert_eq!(turns.turn(at(1505)), None);
        assert_eq!(turns.stall, Some(stall), "it is known until the next");
    }
}
