//! The part of a force peak that readings may have missed. Computed from a curve only.

use crate::trials::measure::curve::{CurvePoint, TimeSeries};
use serde::{Deserialize, Serialize};

/// Force readings no further apart than this miss no peak, s: a grip stays at its impact force for longer.
pub const GAP_S: f64 = 0.025;
/// A gap is unusual at this multiple of the usual interval.
const GAP_TIMES: f64 = 2.5;
/// A peak may come this long after the drive reports its stop, s: the report is not read at once.
const PEAK_LATE_S: f64 = 0.05;
/// If the reading after the highest is below this share of it, the impact was shorter than the interval between readings.
const BRIEF_BELOW: f64 = 0.7;
/// A drop is not noise above this many times the noise plus some grams.
const BRIEF_SIGMAS: f64 = 6.0;
const BRIEF_G: f64 = 20.0;

/// Reason why the peak of a close may exceed all readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PeakDoubt {
    /// The readings had an unusual gap there.
    Gap,
    /// The force dropped at once, as from a breaking object: the peak was shorter than the interval between readings.
    Brief,
}

/// Possible error of a peak between readings.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Unseen {
    /// Possible extra height of the peak, g, from the steepest rise that was read.
    pub missed_g: f64,
    pub doubt: Option<PeakDoubt>,
}

/// Times of a rise of force, seconds from the command, and the usual rate of readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RiseSpan {
    pub contact_s: f64,
    pub stop_s: f64,
    /// Readings per second.
    pub rate_hz: f64,
    pub noise_g: f64,
}

/// The force possibly missed from contact to stop, for a curve relative to rest. In a long gap, or beside a single reading far above
/// the next, the force may have risen as steeply as anywhere in the curve.
pub fn unseen(force: &TimeSeries, span: RiseSpan) -> Unseen {
    let usual = 1.0 / span.rate_hz.max(1.0);
    let (from, to) = (span.contact_s, span.stop_s + PEAK_LATE_S);
    let points: Vec<CurvePoint> = force
        .between(from - 2.0 * usual - GAP_S, to + 2.0 * usual + GAP_S)
        .collect();
    let first = points.iter().rposition(|point| point.t < from);
    // The gap may be longer than the part examined before the contact.
    let before = force.points().iter().rfind(|point| point.t < from);
    let before = before.copied().filter(|_| first.is_none());
    let points: Vec<CurvePoint> = before.into_iter().chain(points).collect();
    let pairs = || points.iter().zip(points.iter().skip(1));
    let slopes = pairs().map(|(a, b)| (b.v - a.v) / (b.t - a.t).max(1e-3));
    let steepest = slopes.fold(0.0, f64::max);
    let peak = points.iter().map(|point| point.v).fold(0.0, f64::max);
    let least = BRIEF_SIGMAS * span.noise_g + BRIEF_G;
    let mut unseen = Unseen::default();
    for (a, b) in pairs().filter(|(a, b)| b.t >= from && a.t <= to) {
        let apart = b.t - a.t;
        let is_brief = a.v >= peak && b.v < BRIEF_BELOW * peak && a.v - b.v > least;
        if apart > GAP_S || is_brief {
            let missed = a.v.max(0.0) + steepest * apart - peak;
            unseen.missed_g = unseen.missed_g.max(missed);
        }
        if apart > GAP_S.max(GAP_TIMES * usual) {
            unseen.doubt = Some(PeakDoubt::Gap);
        } else if is_brief {
            unseen.doubt.get_or_insert(PeakDoubt::Brief);
        }
    }
    unseen
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPAN: RiseSpan = RiseSpan {
        contact_s: 0.5,
        stop_s: 0.6,
        rate_hz: 100.0,
        noise_g: 0.0,
    };

    /// 5000 g/s from 0.5 to 0.6 s, then nearly level, read where `keep` returns true.
    fn seen(keep: impl Fn(f64) -> bool, force: impl Fn(f64) -> f64) -> Unseen {
        let times = (0..150).map(|n| f64::from(n) * 0.01 + 0.003);
        let curve: TimeSeries = times.filter(|t| keep(*t)).map(|t| (t, force(t))).collect();
        unseen(&curve, SPAN)
    }

    fn grip(t: f64) -> f64 {
        let risen = 5000.0 * (t - 0.5).clamp(0.0, 0.1);
        risen - 40.0 * (t - 0.6).max(0.0)
    }

    #[test]
    fn readings_as_usual_miss_nothing() {
        assert_eq!(seen(|_| true, grip), Unseen::default());
        // A gap before the contact or in the dwell does not count either.
        assert_eq!(seen(|t| !(0.2..0.4).contains(&t), grip).doubt, None);
        assert_eq!(seen(|t| !(0.8..1.2).contains(&t), grip).doubt, None);
    }

    #[test]
    fn a_gap_at_the_contact_or_at_the_peak_is_in_doubt_and_tells_what_it_may_hide() {
        for gap in [0.57..0.65, 0.48..0.54, 0.3..0.54] {
            let unseen = seen(|t| !gap.contains(&t), grip);
            assert_eq!(unseen.doubt, Some(PeakDoubt::Gap), "{gap:?}");
        }
        let unseen = seen(|t| !(0.57..0.65).contains(&t), grip);
        // From 315 g at 0.563 s it may rise for another 90 ms; the next reading is 498 g.
        assert!((unseen.missed_g - 267.0).abs() < 20.0, "{unseen:?}");
    }

    #[test]
    fn a_force_that_falls_at_once_was_shorter_than_the_readings_are_apart() {
        let breaks = |t: f64| if t < 0.56 { grip(t) } else { 5.0 };
        let unseen = seen(|_| true, breaks);
        assert_eq!(unseen.doubt, Some(PeakDoubt::Brief));
        assert!(unseen.missed_g > 30.0, "{unseen:?}");
    }
}
