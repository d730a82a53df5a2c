//! Keeps drives cool: derives the allowed load from measured temperature, its slope and the current.

use crate::hand::heat::{MAX_AGE, WARM};
use crate::hand::{Dof, HandSample, Moment, PerDof};
use std::collections::VecDeque;
use std::time::Duration;

/// Maximum temperature of a drive, °C.
pub const HOT: f32 = WARM as f32;
/// The hand rests if a drive is expected to reach this, °C, …
const REST_AT: f32 = 56.0;
/// … and moves slowly from this on, °C.
const SLOW_AT: f32 = 50.0;
/// A rest lasts until all drives are at or below this, °C.
const RESTED_AT: f32 = 46.0;
/// Horizon of the forecast, s.
const AHEAD_S: f32 = 20.0;
/// Time span of the slope.
const SLOPE_OVER: Duration = Duration::from_secs(20);
/// Interval of stored temperatures: about twenty values per drive.
const SAMPLE_INTERVAL: Duration = Duration::from_secs(1);
/// Heating of a drive, °C/s per A²: half as much again as estimated for a sister hand, which publishes no figure.
const HEATING: f32 = 0.66;
/// Averaging time of the squared current, s.
const CURRENT_OVER_S: f32 = 10.0;

/// The load that the drive temperatures allow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum HeatLevel {
    /// Motion within the configured limits.
    Cool,
    /// Half speed.
    Warm,
    /// Opening and resting only.
    Hot,
    /// A temperature is unknown or outdated: treated as hot.
    Unknown,
}

/// Watches the temperatures of six drives.
#[derive(Debug, Clone, Default)]
pub struct HeatGovernor {
    temperatures: VecDeque<(Moment, PerDof<f32>)>,
    /// Squared current, A², averaged.
    squares: PerDof<f32>,
    current_at: Option<Moment>,
    newest: Option<(Moment, PerDof<f32>)>,
}

impl HeatGovernor {
    /// Applies a sample. Readings that are not newer are ignored.
    pub fn apply(&mut self, sample: &HandSample) {
        if let Some(current) = sample.current
            && self.current_at.is_none_or(|at| current.received > at)
        {
            let passed = self.current_at.map(|at| current.received.since(at));
            let share = passed.map_or(1.0, |passed| passed.as_secs_f32() / CURRENT_OVER_S);
            for (dof, square) in self.squares.iter_mut() {
                // An implausible current counts as zero; the temperature shows the heating anyway.
                let amps = current.value[dof].documented().map_or(0.0, f32::from) / 1000.0;
                *square += (amps * amps - *square) * share.min(1.0);
            }
            self.current_at = Some(current.received);
        }
        let Some(temperature) = sample.temperature else {
            return;
        };
        if self
            .newest
            .is_some_and(|(at, _)| temperature.received <= at)
        {
            return;
        }
        let known = temperature.value.map(|celsius| celsius.documented());
        let Some(celsius) = known.all().map(|all| all.map(f32::from)) else {
            return;
        };
        let at = temperature.received;
        self.newest = Some((at, celsius));
        let last = self.temperatures.back().map(|(last, _)| at.since(*last));
        if last.is_none_or(|last| last >= SAMPLE_INTERVAL) {
            self.temperatures.push_back((at, celsius));
        }
        while let Some((first, _)) = self.temperatures.front()
            && at.since(*first) > SLOPE_OVER
        {
            self.temperatures.pop_front();
        }
    }

    /// The heat level at this moment.
    pub fn level(&self, now: Moment) -> HeatLevel {
        let Some(celsius) = self.fresh(now) else {
            return HeatLevel::Unknown;
        };
        let expected = Dof::ALL.map(|dof| celsius[dof] + self.rise(dof) * AHEAD_S);
        match expected.into_iter().fold(f32::MIN, f32::max) {
            at if at >= REST_AT => HeatLevel::Hot,
            at if at >= SLOW_AT => HeatLevel::Warm,
            _ => HeatLevel::Cool,
        }
    }

    /// True once a rest has cooled every drive enough.
    pub fn is_rested(&self, now: Moment) -> bool {
        let cool = |celsius: PerDof<f32>| celsius.iter().all(|(_, at)| *at <= RESTED_AT);
        self.fresh(now).is_some_and(cool)
    }

    fn fresh(&self, now: Moment) -> Option<PerDof<f32>> {
        let newest = self.newest.filter(|(at, _)| now.since(*at) <= MAX_AGE);
        newest.map(|(_, celsius)| celsius)
    }

    /// Expected heating, °C/s: the larger of the measured slope and the heating by the current.
    fn rise(&self, dof: Dof) -> f32 {
        let measured = match (self.temperatures.front(), self.newest) {
            (Some((first, then)), Some((last, now))) if last > *first => {
                (now[dof] - then[dof]) / last.since(*first).as_secs_f32().max(5.0)
            }
            _ => 0.0,
        };
        measured.max(HEATING * self.squares[dof])
    }
}
