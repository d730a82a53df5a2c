//! How long a drive that is too hot still has to cool: read off the course of its temperature. Tells no drive anything.
//!
//! Manual: 2.6.3 says that over-temperature ends by itself when the drive is cool, and gives no temperature at all. Until
//! this hand has shown at which one it works again, [`WORKS_AGAIN_C`] is assumed.

use crate::hand::Dof;
use crate::hand::Quantity;
use crate::history::{History, Series};
use std::time::Duration;

/// The temperature at which a drive is taken to work again, °C: where guards of the field's drivers stand. An assumption.
pub const WORKS_AGAIN_C: f32 = 70.0;
/// Temperature that a resting drive cools towards, °C: the lower end of what resting drives show. An assumption.
pub const AMBIENT_C: f32 = 25.0;
/// How far back temperatures are used: two time constants of a small drive at most, so that heating up is soon forgotten.
const LOOK_BACK_S: f64 = 120.0;
/// Seconds of measurements averaged into one point: readings come in whole degrees.
const POINT_S: f64 = 3.0;
/// Fewer points say nothing.
const POINTS_MIN: usize = 4;
/// A smaller fall over all points is the step from one whole degree to the next.
const FALL_MIN_C: f64 = 1.5;
/// The fall must be this many of its own standard errors.
const SURE: f64 = 3.0;
/// No estimate goes further.
pub const LONGEST: Duration = Duration::from_secs(3600);

/// Where the wanted temperature comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GoalSource {
    /// [`WORKS_AGAIN_C`].
    Assumed,
    /// The last over-temperature of this drive ended there.
    Observed,
}

/// The temperature to be reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoolingGoal {
    /// °C.
    pub celsius: f32,
    /// Where it comes from.
    pub source: GoalSource,
}

impl CoolingGoal {
    /// What this hand showed, else what is assumed.
    #[must_use]
    pub fn of(observed: Option<f32>) -> Self {
        observed.map_or(
            Self {
                celsius: WORKS_AGAIN_C,
                source: GoalSource::Assumed,
            },
            |celsius| Self {
                celsius,
                source: GoalSource::Observed,
            },
        )
    }
}

/// How the temperature goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// Too little was measured to say.
    Unknown,
    /// It does not fall, or not more than it wavers.
    NotFalling,
    /// It falls, and needs this long if it goes on towards [`AMBIENT_C`].
    Falling {
        /// At most [`LONGEST`].
        left: Duration,
    },
    /// It is there.
    Reached,
}

/// How this drive's temperature goes on. The work does not grow with the history.
#[must_use]
pub fn course(history: &History, dof: Dof, now_s: f64, goal: CoolingGoal) -> Course {
    let series = Series::Joint(Quantity::Temperature, dof);
    let mut points = Vec::new();
    let mut from_s = now_s - LOOK_BACK_S;
    while from_s < now_s {
        let to_s = from_s + POINT_S;
        if let Some(summary) = history.summary(series, from_s, to_s.next_down()) {
            points.push((from_s + POINT_S / 2.0 - now_s, summary.mean));
        }
        from_s = to_s;
    }
    extrapolate(&points, goal.celsius.into())
}

/// From points of (seconds from now, °C), oldest first: an exponential towards [`AMBIENT_C`] through those since it was
/// hottest last, by least squares.
#[must_use]
pub fn extrapolate(points: &[(f64, f64)], goal_c: f64) -> Course {
    let ambient = f64::from(AMBIENT_C);
    let hottest = points
        .iter()
        .map(|(_, celsius)| *celsius)
        .fold(f64::MIN, f64::max);
    // A drive stays at its hottest for a while before it cools.
    let nearly = hottest - FALL_MIN_C / 2.0;
    let since = points.iter().rposition(|(_, celsius)| *celsius >= nearly);
    let fall = since.and_then(|since| points.get(since..)).unwrap_or(&[]);
    match points.last() {
        Some((_, newest)) if *newest <= goal_c => return Course::Reached,
        _ if points.len() < POINTS_MIN => return Course::Unknown,
        _ => {}
    }
    let excess: Vec<(f64, f64)> = fall
        .iter()
        .filter(|(_, celsius)| *celsius > ambient)
        .map(|(at_s, celsius)| (*at_s, (celsius - ambient).ln()))
        .collect();
    let Some(line) = FittedLine::through(&excess) else {
        // The hottest is among the newest points: it has only begun to fall, or it wavers.
        let begun = points
            .last()
            .is_some_and(|(_, newest)| hottest - newest >= FALL_MIN_C);
        return if begun {
            Course::Unknown
        } else {
            Course::NotFalling
        };
    };
    let value = |at_s: f64| line.at_zero + line.slope * at_s;
    let first_s = excess.first().map_or(0.0, |(at_s, _)| *at_s);
    let fallen = value(first_s).exp() - value(0.0).exp();
    if line.slope >= -SURE * line.error || fallen < FALL_MIN_C || goal_c <= ambient {
        return Course::NotFalling;
    }
    let left_s = (value(0.0) - (goal_c - ambient).ln()) / -line.slope;
    let left = Duration::try_from_secs_f64(left_s.max(0.0)).unwrap_or(LONGEST);
    Course::Falling {
        left: left.min(LONGEST),
    }
}

/// A straight line through points.
struct FittedLine {
    at_zero: f64,
    slope: f64,
    /// Standard error of the slope.
    error: f64,
}

impl FittedLine {
    fn through(points: &[(f64, f64)]) -> Option<Self> {
        if points.len() < POINTS_MIN {
            return None;
        }
        let count = f64::from(u32::try_from(points.len()).ok()?);
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (x0, y0) = (mean(|point| point.0), mean(|point| point.1));
        let spread: f64 = points.iter().map(|(x, _)| (x - x0).powi(2)).sum();
        let both: f64 = points.iter().map(|(x, y)| (x - x0) * (y - y0)).sum();
        let slope = both / spread;
        let miss = |(x, y): &(f64, f64)| (y - y0 - slope * (x - x0)).powi(2);
        let error = (points.iter().map(miss).sum::<f64>() / (count - 2.0) / spread).sqrt();
        (spread > 0.0).then_some(Self {
            at_zero: y0 - slope * x0,
            slope,
            error,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Group, Groups, HandSample, Moment, PerDof, TemperatureReading, Timed};

    /// Readings in whole degrees, ten a second, with noise, as a hand sends them.
    fn history(seconds: u32, seed: u32, celsius: impl Fn(f64) -> f64) -> History {
        let mut history = History::new();
        let mut random = seed;
        for tick in 0..seconds * 10 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(random >> 16) / 65_536.0 - 0.5;
            let at = f64::from(tick) / 10.0;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "0..=100"
            )]
            let raw = (celsius(at) + 1.6 * noise).round() as u8;
            let at = Moment::from_micros(u64::from(tick) * 100_000);
            let sample = HandSample {
                temperature: Some(Timed {
                    value: PerDof::splat(TemperatureReading::new(raw)),
                    asked: at,
                    received: at,
                }),
                ..HandSample::default()
            };
            let mut fresh = Groups::NONE;
            fresh.insert(Group::Temperature);
            history.push(&sample, fresh);
        }
        history
    }

    fn after(seconds: u32, seed: u32, celsius: impl Fn(f64) -> f64) -> Course {
        let history = history(seconds, seed, celsius);
        course(
            &history,
            Dof::Ring,
            f64::from(seconds),
            CoolingGoal::of(None),
        )
    }

    #[test]
    fn a_cooling_drive_gets_a_time_that_comes_true() {
        let cools = |tau: f64| move |at: f64| 25.0 + 67.0 * (-at / tau).exp();
        for tau in [60.0, 180.0, 400.0] {
            // When it truly is at 70.
            let there = tau * (67.0_f64 / 45.0).ln();
            for seed in 0..20 {
                for part in [0.5, 0.8] {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "seconds"
                    )]
                    let at = (there * part) as u32;
                    if at < 30 {
                        continue;
                    }
                    let Course::Falling { left } = after(at, seed, cools(tau)) else {
                        panic!("no estimate after {at} s at {tau} s, seed {seed}");
                    };
                    let want = there - f64::from(at);
                    let wrong = (left.as_secs_f64() - want).abs();
                    assert!(
                        wrong < 0.25 * want + 4.0,
                        "{left:?}, not {want} s ({tau}, {seed})"
                    );
                }
            }
        }
    }

    #[test]
    fn a_drive_that_warms_or_stays_gets_no_time() {
        for seed in 0..100 {
            assert_eq!(
                after(110, seed, |_| 88.4),
                Course::NotFalling,
                "flat, {seed}"
            );
            assert_eq!(
                after(110, seed, |at| 72.0 + at / 8.0),
                Course::NotFalling,
                "{seed}"
            );
            let begins = |at: f64| 90.0 - (at - 105.0).max(0.0);
            let course = after(110, seed, begins);
            assert_eq!(course, Course::Unknown, "too early, {seed}");
        }
    }

    #[test]
    fn heating_up_before_does_not_spoil_the_estimate() {
        let curve = |at: f64| {
            if at < 60.0 {
                60.0 + at / 2.0
            } else {
                25.0 + 65.0 * (-(at - 60.0) / 120.0).exp()
            }
        };
        let Course::Falling { left } = after(90, 3, curve) else {
            panic!("no estimate");
        };
        let want = 120.0 * (65.0_f64 / 45.0).ln() - 30.0;
        assert!(
            (left.as_secs_f64() - want).abs() < 5.0,
            "{left:?}, not {want} s"
        );
    }

    #[test]
    fn little_says_nothing_and_cool_is_cool() {
        assert_eq!(after(9, 1, |_| 90.0), Course::Unknown);
        assert_eq!(extrapolate(&[], 70.0), Course::Unknown);
        assert_eq!(after(60, 1, |_| 60.0), Course::Reached);
        let slow = |step: i32| (f64::from(step - 5) * 40.0, 92.0 - 0.6 * f64::from(step));
        let slow = extrapolate(&[0, 1, 2, 3, 4, 5].map(slow), 26.0);
        assert_eq!(slow, Course::Falling { left: LONGEST });
    }

    #[test]
    fn what_this_hand_showed_goes_before_what_is_assumed() {
        assert_eq!(CoolingGoal::of(None).source, GoalSource::Assumed);
        let own = CoolingGoal::of(Some(62.0));
        assert_eq!((own.celsius, own.source), (62.0, GoalSource::Observed));
        assert_eq!(
            extrapolate(&[(-1.0, 65.0)], own.celsius.into()),
            Course::Unknown
        );
    }
}
