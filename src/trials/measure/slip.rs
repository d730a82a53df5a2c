//! Slips of a held object: sudden or creeping changes of friction. Computed from curves only.

use crate::hand::grip::GripThresholds;
use crate::hand::grip::slip::{APART_S, BEFORE_LEAST, HELD_N, HeldMoment, SlipDetector, SlipJump};
use crate::trials::measure::curve::{JointCurves, TimeSeries};
use serde::{Deserialize, Serialize};

/// Tangential and normal force of one read are at most this far apart.
const TOGETHER_S: f64 = 0.001;

/// One slip of the object on a fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SlipEvent {
    /// First sighting, seconds from the closing command.
    pub at_s: f64,
    /// Largest rise of the ratio of tangential to normal force.
    pub ratio_jump: f64,
    /// Largest rotation of the tangential force, degrees; `None` if the direction is unknown.
    pub turn_deg: Option<f64>,
}

/// The slips in an interval; `None` with too few readings of the fingertip.
///
/// A jump counts if two readings in a row show it, so slips are detected one reading late, and those shorter than two
/// readings (40 ms on a sensor of 50 Hz) are missed.
pub fn slips(curves: &JointCurves, from: f64, to: f64) -> Option<Vec<SlipEvent>> {
    let held = moments(curves, from, to);
    if held.len() <= BEFORE_LEAST {
        return None;
    }
    let mut found: Vec<SlipEvent> = Vec::new();
    let mut detector = SlipDetector::new(&GripThresholds::default());
    for now in held {
        let before = detector.last().unwrap_or(f64::NEG_INFINITY);
        let Some((first, second)) = detector.push(now) else {
            continue;
        };
        match found.last_mut().filter(|_| first.t - before < APART_S) {
            Some(known) => known.widen(&second.into()),
            None => {
                let mut slip = SlipEvent::from(first);
                slip.widen(&second.into());
                found.push(slip);
            }
        }
    }
    Some(found)
}

impl From<SlipJump> for SlipEvent {
    fn from(jump: SlipJump) -> Self {
        Self {
            at_s: jump.t,
            ratio_jump: jump.ratio,
            turn_deg: jump.turn_deg,
        }
    }
}

impl SlipEvent {
    fn widen(&mut self, other: &Self) {
        self.ratio_jump = self.ratio_jump.max(other.ratio_jump);
        self.turn_deg = match (self.turn_deg, other.turn_deg) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        };
    }
}

fn moments(curves: &JointCurves, from: f64, to: f64) -> Vec<HeldMoment> {
    let near = |curve: &TimeSeries, t: f64| {
        let mut points = curve.between(t - TOGETHER_S, t + TOGETHER_S);
        points.next().map(|point| point.v)
    };
    curves
        .normal
        .between(from, to)
        .filter(|normal| normal.v >= HELD_N)
        .filter_map(|normal| {
            let tangential = near(&curves.tangential, normal.t)?;
            Some(HeldMoment {
                t: normal.t,
                ratio: tangential / normal.v,
                direction: near(&curves.direction, normal.t),
                spot_mm: None,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grip of 5 N read 50 times a second for 3 s.
    fn grip(ratio: impl Fn(f64) -> f64, direction: impl Fn(f64) -> f64) -> JointCurves {
        let times = || (0..150).map(|n| f64::from(n) * 0.02);
        JointCurves {
            normal: times().map(|t| (t, 5.0)).collect(),
            tangential: times().map(|t| (t, 5.0 * ratio(t))).collect(),
            direction: times()
                .map(|t| (t, direction(t).rem_euclid(360.0)))
                .collect(),
            ..JointCurves::default()
        }
    }

    #[test]
    fn a_steady_grip_does_not_slip_and_silence_is_unknown() {
        let wander = |t: f64| 0.2 + 0.03 * (1.3 * t).sin();
        let still = grip(wander, |t| 358.0 + 4.0 * t.sin());
        assert_eq!(slips(&still, 0.0, 3.0), Some(Vec::new()));
        assert_eq!(slips(&JointCurves::default(), 0.0, 3.0), None);
    }

    #[test]
    fn a_jump_of_friction_is_one_slip_at_its_time() {
        let bump = |t: f64| if (1.5..1.7).contains(&t) { 0.5 } else { 0.2 };
        let found = slips(&grip(bump, |_| 10.0), 0.0, 3.0).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].at_s - 1.5).abs() < 0.021);
        assert!((found[0].ratio_jump - 0.3).abs() < 0.01);
        assert!(found[0].turn_deg.unwrap() < 1.0);
    }

    #[test]
    fn a_wrist_that_turns_through_north_is_no_slip_and_two_jumps_far_apart_are_two() {
        let turns = |t: f64| 330.0 + 90.0 * ((t - 1.0) / 0.8).clamp(0.0, 1.0);
        assert_eq!(slips(&grip(|_| 0.2, turns), 0.0, 3.0), Some(Vec::new()));
        let jumps = |t: f64| match t {
            t if t < 1.0 => 0.2,
            t if t < 2.0 => 0.4,
            _ => 0.6,
        };
        let turned = |t: f64| if t < 1.0 { 350.0 } else { 30.0 };
        let found = slips(&grip(jumps, turned), 0.0, 3.0).unwrap();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0].turn_deg.unwrap() - 40.0).abs() < 1.0);
        assert!((found[1].at_s - 2.0).abs() < 0.021);
        assert!(found[1].turn_deg.unwrap() < 1.0);
    }

    #[test]
    fn friction_that_rises_for_seconds_is_one_slip_before_the_rise_is_over() {
        for (rise, seconds) in [(0.2, 1.5), (0.3, 2.0), (0.25, 2.0)] {
            let creeps = |t: f64| 0.2 + rise * ((t - 0.8) / seconds).clamp(0.0, 1.0);
            let found = slips(&grip(creeps, |_| 10.0), 0.0, 3.0).unwrap();
            assert_eq!(found.len(), 1, "{rise} in {seconds} s: {found:?}");
            assert!(found[0].at_s < 0.8 + seconds, "{found:?}");
        }
    }

    #[test]
    fn one_wild_reading_is_no_slip() {
        let wild = |t: f64| if (1.49..1.51).contains(&t) { 0.9 } else { 0.2 };
        assert_eq!(slips(&grip(wild, |_| 10.0), 0.0, 3.0), Some(Vec::new()));
    }
}
