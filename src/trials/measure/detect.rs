//! The start of a rise in a curve, and its noise. Knows no joint and no trial.

use crate::hand::statistics::{count, median, spread};
use crate::trials::measure::curve::{CurvePoint, TimeSeries};

/// Level and noise of a curve at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestLevel {
    /// The median.
    pub level: f64,
    /// The standard deviation without outliers.
    pub sigma: f64,
}

/// Fewer values give no noise level.
const REST_LEAST: usize = 3;
/// A value is an outlier beyond this many standard deviations, estimated from the median deviation …
const WILD_SIGMAS: f64 = 4.0;
/// … which is at least this, since readings are whole numbers and low noise has a median deviation of zero.
const WHOLE: f64 = 1.0;

/// Level and noise in an interval; `None` with fewer than 3 values.
pub fn rest(curve: &TimeSeries, from: f64, to: f64) -> Option<RestLevel> {
    /// Ratio of standard deviation to median deviation, of a normal distribution.
    const BY_MEDIAN: f64 = 1.4826;
    let values = curve.values(from, to);
    if values.len() < REST_LEAST {
        return None;
    }
    let level = median(&values)?;
    let away: Vec<f64> = values.iter().map(|value| (value - level).abs()).collect();
    let about = (median(&away)? * BY_MEDIAN).max(WHOLE);
    let is_tame = |value: &f64| (value - level).abs() <= WILD_SIGMAS * about;
    let tame: Vec<f64> = values.into_iter().filter(is_tame).collect();
    let freedom = (count(&tame) - 1.0).max(1.0);
    Some(RestLevel {
        level,
        sigma: (spread(&tame) / freedom).sqrt(),
    })
}

/// Longest gap to interpolate across, s. Across a longer one the course is unknown, and the event counts from the later reading:
/// late, never early.
const LINE_MAX_S: f64 = 0.06;

/// Time at which a curve first exceeds a level with two values in a row, interpolated from the last value below if that is near.
/// `None` if it does not, or if the first known value is already above.
pub fn passes(points: impl Iterator<Item = CurvePoint>, level: f64) -> Option<f64> {
    let mut before: Option<CurvePoint> = None;
    let mut first: Option<f64> = None;
    for point in points {
        if point.v < level {
            before = Some(point);
            first = None;
            continue;
        }
        if let Some(at) = first {
            return Some(at);
        }
        let from = before?;
        let share = (level - from.v) / (point.v - from.v).max(f64::EPSILON);
        let apart = point.t - from.t;
        first = Some(if apart > LINE_MAX_S {
            point.t
        } else {
            from.t + apart * share.clamp(0.0, 1.0)
        });
    }
    None
}

/// Time at which a curve starts a ramp from rest: it passes `level` for good, and the line from there to twice the level is extended
/// back to zero, but not before the last value below a third of the level.
pub fn begins(curve: &TimeSeries, from: f64, level: f64) -> Option<f64> {
    let points = || curve.between(from, f64::INFINITY);
    let one = passes(points(), level)?;
    let last_low = points()
        .take_while(|point| point.t <= one)
        .filter(|point| point.v < level / 3.0)
        .last()?;
    let two = points().find(|point| point.t > one && point.v >= 2.0 * level);
    let back = two.map_or(one, |two| {
        let slope = (two.v - level) / (two.t - one).max(f64::EPSILON);
        one - level / slope.max(f64::EPSILON)
    });
    Some(back.clamp(last_low.t, one))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_and_of_nothing_there_is_none() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[f64::NAN]), None);
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
    }

    #[test]
    fn a_single_wild_value_is_no_rise_and_no_noise() {
        let mut points: Vec<(f64, f64)> = (0..100).map(|n| (f64::from(n) * 0.01, 0.0)).collect();
        points[50].1 = 900.0;
        let curve: TimeSeries = points.into_iter().collect();
        assert_eq!(passes(curve.between(0.0, 1.0), 10.0), None);
        assert_eq!(rest(&curve, 0.0, 1.0).unwrap().sigma, 0.0);
    }

    #[test]
    fn the_noise_of_whole_grams_is_no_multiple_of_a_median_deviation() {
        let mut rng = fastrand::Rng::with_seed(3);
        let mut normal = |sigma: f64| {
            let sum: f64 = (0..12).map(|_| rng.f64()).sum();
            (sigma * (sum - 6.0)).round()
        };
        for truth in [1.0, 2.0, 3.0, 4.0, 6.0] {
            let sigmas: Vec<f64> = (0..200)
                .map(|_| {
                    let curve = (0..45).map(|n| (f64::from(n) * 0.01, normal(truth)));
                    let curve: TimeSeries = curve.collect();
                    rest(&curve, 0.0, 1.0).unwrap().sigma
                })
                .collect();
            let mean = sigmas.iter().sum::<f64>() / 200.0;
            assert!((mean / truth - 1.0).abs() < 0.06, "{truth}: {mean}");
            // 45 readings determine it within 11 %, one standard deviation.
            let off = sigmas.iter().map(|own| (own / truth - 1.0).abs());
            let far = off.filter(|off| *off > 0.25).count();
            assert!(far <= 15, "{truth}: {far} of 200");
        }
    }

    #[test]
    fn a_ramp_begins_where_it_leaves_zero_within_a_sample() {
        for start in [0.2, 0.203, 0.2071] {
            let ramp = |t: f64| ((t - start) * 400.0).max(0.0);
            let curve: TimeSeries = (0..100)
                .map(|n| f64::from(n) * 0.01)
                .map(|t| (t, ramp(t)))
                .collect();
            let seen = begins(&curve, 0.0, 3.0).unwrap();
            assert!((seen - start).abs() < 0.003, "{start} {seen}");
        }
    }

    #[test]
    fn between_readings_far_apart_nothing_is_made_up() {
        let rare = |apart: f64| {
            let values = [0.0, 0.0, 9.0, 9.0].into_iter().enumerate();
            let points = values.map(|(n, v)| (f64::from(u32::try_from(n).unwrap()) * apart, v));
            passes(points.collect::<TimeSeries>().between(0.0, 9.0), 0.9).unwrap()
        };
        assert!((rare(0.05) - 0.055).abs() < 1e-9);
        assert!((rare(0.3) - 0.6).abs() < 1e-9);
    }

    #[test]
    fn what_was_beyond_from_the_first_has_no_beginning() {
        let curve: TimeSeries = (0..10).map(|n| (f64::from(n), 50.0)).collect();
        assert_eq!(passes(curve.between(0.0, 9.0), 10.0), None);
        assert_eq!(begins(&curve, 0.0, 10.0), None);
    }
}
