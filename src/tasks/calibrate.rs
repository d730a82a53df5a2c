//! The calibration of the force sensors: its conditions, the request, and the offsets afterwards (manual 2.6.6).

use crate::hand::{Dof, Finger, ForceReading, HandSample, Moment, PerDof};
use crate::link::{Clock, LinkHandle, LinkStatus, RequestError};
use crate::record::{Calibrated, LinkState, Record, Rest};
use crate::tasks::TaskStep;
use std::collections::VecDeque;
use std::time::Duration;
use tokio::time::{Instant, timeout_at};

/// An angle from here on counts as open: the condition that drivers of this family require before a calibration.
pub const OPEN_FROM: i16 = 950;
/// A larger force than any offset of a hand at rest, g.
pub const FREE_BELOW_G: u16 = 400;
/// A fingertip counts as touched above this force, N.
pub const TOUCH_N: f32 = 0.3;
/// Time for which the force has to be steady.
const STEADY_DURATION: Duration = Duration::from_secs(2);
/// Maximum change in that time, g.
const STEADY_G: i16 = 20;
/// Maximum number of stored samples: two seconds of the fastest wire.
const SAMPLES_MAX: usize = 512;
/// Older samples are ignored.
const MAX_AGE: Duration = Duration::from_millis(500);
/// Time for which the new offset is measured after the end.
const MEASURE_DURATION: Duration = Duration::from_millis(1500);

/// Maximum duration. Manual: 2.6.6 names no time; hands in use took 2 to 6 s.
pub const TAKES: Duration = Duration::from_secs(8);

/// Condition for calibrating the force sensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CalibrationCondition {
    /// Every joint is open.
    Open,
    /// No joint moves.
    Still,
    /// No force, and no fingertip is touched.
    Untouched,
    /// The force does not change.
    Steady,
    /// No drive reports a fault.
    NoFault,
    /// This program has armed nothing, and no stop is under way.
    Disarmed,
}

impl CalibrationCondition {
    /// All, in the order in which the user meets them.
    pub const ALL: [Self; 6] = [
        Self::Disarmed,
        Self::NoFault,
        Self::Open,
        Self::Still,
        Self::Untouched,
        Self::Steady,
    ];
}

/// Forces by joint, g.
pub type Offsets = PerDof<i16>;

/// Evaluates the conditions of a calibration, from some seconds of force readings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checks {
    forces: VecDeque<(Moment, Offsets)>,
}

impl Checks {
    /// Adds the newest force.
    pub fn watch(&mut self, sample: &HandSample) {
        let Some(force) = sample.force else { return };
        if self.forces.back().is_some_and(|last| last.0 >= force.asked) {
            return;
        }
        if self.forces.len() >= SAMPLES_MAX {
            self.forces.pop_front();
        }
        let grams = force.value.map(ForceReading::raw);
        self.forces.push_back((force.asked, grams));
        let from = force.asked;
        while let Some((at, _)) = self.forces.front()
            && from.since(*at) > STEADY_DURATION + MAX_AGE
        {
            self.forces.pop_front();
        }
    }

    /// True if the condition is met; `None` if that is not known.
    pub fn check(
        &self,
        check: CalibrationCondition,
        sample: &HandSample,
        link: &LinkStatus,
        now: Moment,
    ) -> Option<bool> {
        let fresh = |asked: Moment| link.state.is_live() && now.since(asked) <= MAX_AGE;
        match check {
            CalibrationCondition::Disarmed => match link.state {
                LinkState::Offline | LinkState::Identifying => None,
                state => Some(!matches!(state, LinkState::Armed | LinkState::Holding)),
            },
            CalibrationCondition::NoFault => {
                let all = sample.faults.filter(|all| fresh(all.asked))?;
                Some(all.value.iter().all(|(_, faults)| faults.is_empty()))
            }
            CalibrationCondition::Open => {
                let all = sample.angle.filter(|all| fresh(all.asked))?;
                let is_open =
                    |dof: Dof| dof == Dof::ThumbRotate || all.value[dof].raw() >= OPEN_FROM;
                Some(Dof::ALL.into_iter().all(is_open))
            }
            CalibrationCondition::Still => match link.rest {
                Rest::Unknown => None,
                rest => Some(rest == Rest::Resting),
            },
            CalibrationCondition::Untouched => {
                let all = sample.force.filter(|all| fresh(all.asked))?;
                let free = |force: &ForceReading| force.raw().unsigned_abs() <= FREE_BELOW_G;
                Some(all.value.iter().all(|(_, force)| free(force)) && is_untouched(sample)?)
            }
            CalibrationCondition::Steady => self.is_steady(now),
        }
    }

    fn is_steady(&self, now: Moment) -> Option<bool> {
        let (first, last) = (self.forces.front()?, self.forces.back()?);
        if now.since(last.0) > MAX_AGE || last.0.since(first.0) < STEADY_DURATION {
            return None;
        }
        Some(Dof::ALL.into_iter().all(|dof| {
            let all = self.forces.iter().map(|(_, forces)| forces[dof]);
            let (least, most) = (all.clone().min(), all.max());
            let spread = least
                .zip(most)
                .map(|(least, most)| most.saturating_sub(least));
            spread.is_some_and(|spread| spread <= STEADY_G)
        }))
    }

    /// True if all conditions are met.
    pub fn is_ready(&self, sample: &HandSample, link: &LinkStatus, now: Moment) -> bool {
        let is_so = |check| self.check(check, sample, link, now) == Some(true);
        CalibrationCondition::ALL.into_iter().all(is_so)
    }

    /// Mean of the stored forces; `None` without any.
    pub fn mean(&self) -> Option<Offsets> {
        let count = i64::try_from(self.forces.len())
            .ok()
            .filter(|count| *count > 0)?;
        Some(PerDof::from_fn(|dof| {
            let all = self.forces.iter().map(|(_, forces)| i64::from(forces[dof]));
            i16::try_from(all.sum::<i64>() / count).unwrap_or_default()
        }))
    }
}

/// Outcome of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrateReport {
    /// Its result, or the reason for which it was not sent.
    pub end: Result<Calibrated, RequestError>,
    /// Offsets after the calibration; `None` if they were not measured.
    pub after: Option<Offsets>,
}

/// Calibrates, and measures the new offsets if the calibration succeeded.
pub async fn calibrate(
    hand: &LinkHandle,
    clock: Clock,
    mut notify: impl FnMut(TaskStep),
) -> CalibrateReport {
    notify(TaskStep::Calibrating);
    let end = hand.calibrate().await;
    let mut after = None;
    if matches!(end, Ok(Calibrated::Finished | Calibrated::Quiet)) {
        notify(TaskStep::Measuring);
        let since = clock.now();
        let mut records = hand.records();
        let mut checks = Checks::default();
        let until = Instant::now() + MEASURE_DURATION;
        while let Ok(Some(record)) = timeout_at(until, records.next()).await {
            if let Record::Reading { sample, .. } = record
                && sample.force.is_some_and(|force| force.asked >= since)
            {
                checks.watch(&sample);
            }
        }
        after = checks.mean();
    }
    CalibrateReport { end, after }
}

/// True if no fingertip is touched; `None` if one was never read.
fn is_untouched(sample: &HandSample) -> Option<bool> {
    let mut is_free = true;
    for finger in Finger::ALL {
        let block = sample.tactile[finger]?.value;
        is_free &= block.normal().is_none_or(|newton| newton.abs() <= TOUCH_N);
    }
    Some(is_free)
}
