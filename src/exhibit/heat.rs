//! Keeps drives cool: from measured temperature, its slope and the current, how much the hand may do.

use crate::hand::heat::{MAX_AGE, WARM};
use crate::hand::{Dof, HandSample, Moment, PerDof};
use std::collections::VecDeque;
use std::time::Duration;

/// No drive is to pass this, °C.
pub const HOT: f32 = WARM as f32;
/// Expected to come as near as this, the hand rests …
const REST_AT: f32 = 56.0;
/// … and so near, it goes slowly.
const SLOW_AT: f32 = 50.0;
/// Warmth that a rest has to bring it down to.
const RESTED_AT: f32 = 46.0;
/// How far ahead is looked.
const AHEAD_S: f32 = 20.0;
/// The slope is that of so long.
const SLOPE_OVER: Duration = Duration::from_secs(20);
/// So often a temperature is kept: twenty values of each drive at most.
const SAMPLE_INTERVAL: Duration = Duration::from_secs(1);
/// Heating of a drive, °C/s for each A²: half more than was reckoned of a sister hand, which says nothing of it.
const HEATING: f32 = 0.66;
/// Over so long the current is averaged.
const CURRENT_OVER_S: f32 = 10.0;

/// What the drives' heat allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum HeatLevel {
    /// Everything within the limits.
    Cool,
    /// Half as fast.
    Warm,
    /// Only to open and to rest.
    Hot,
    /// A temperature is unknown or old: as hot.
    Unknown,
}

/// Looks at the heat of six drives.
#[derive(Debug, Clone, Default)]
pub struct HeatGovernor {
    temperatures: VecDeque<(Moment, PerDof<f32>)>,
    /// A²; averaged.
    squares: PerDof<f32>,
    current_at: Option<Moment>,
    newest: Option<(Moment, PerDof<f32>)>,
}

impl HeatGovernor {
    /// Takes in what was read. Old readings change nothing.
    pub fn take(&mut self, sample: &HandSample) {
        if let Some(current) = sample.current
            && self.current_at.is_none_or(|at| current.received > at)
        {
            let passed = self.current_at.map(|at| current.received.since(at));
            let share = passed.map_or(1.0, |passed| passed.as_secs_f32() / CURRENT_OVER_S);
            for (dof, square) in self.squares.iter_mut() {
                // A current that makes no sense is taken for none; the temperature tells.
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

    /// What the heat allows now.
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

    /// True once a rest has done its work.
    pub fn is_rested(&self, now: Moment) -> bool {
        let cool = |celsius: PerDof<f32>| celsius.iter().all(|(_, at)| *at <= RESTED_AT);
        self.fresh(now).is_some_and(cool)
    }

    fn fresh(&self, now: Moment) -> Option<PerDof<f32>> {
        let newest = self.newest.filter(|(at, _)| now.since(*at) <= MAX_AGE);
        newest.map(|(_, celsius)| celsius)
    }

    /// °C a second that are to be expected: what was measured, or what the current brings, whichever is more.
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
