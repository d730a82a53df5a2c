//! Slip detection for a held object, reading by reading: friction that rises, at once or over seconds. A tangential force that only
//! turns is caused by the wrist.

use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::statistics::median;
use std::collections::VecDeque;

/// Normal force below which there is nothing to slip, N.
pub const HELD_N: f64 = 0.2;
/// Reference period: the median of this many seconds before the reading.
const BEFORE_S: f64 = 0.5;
/// Slips closer to each other than this are one slip.
pub const APART_S: f64 = 0.4;
/// Fewest values from which a jump can be detected.
pub const BEFORE_LEAST: usize = 3;
/// Rise of the median ratio over half a second from which friction creeps. The ratio before the creep is then the reference.
const CREEPS: f64 = 0.02;
/// Number of readings whose median is the current level of a creep.
const LEVEL_COUNT: usize = 5;
/// Share of the rise that suffices where the tangential force turns as well.
const TURNED_SHARE: f64 = 0.75;
/// A rising ratio is a slip from here on: the friction of smooth objects. Below, the object only became heavier, unless its contact
/// moved on the fingertip by so many mm within so many seconds.
const NEAR_FRICTION: f64 = 0.35;
const SPOT_MM: f64 = 0.5;
const SPOT_S: f64 = 1.0;
/// Capacity of the history: one second of a sensor that is read 500 times a second.
const READINGS_MAX: usize = 512;

/// One reading while the fingertip holds something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldMoment {
    /// Time of the reading, s from an arbitrary origin.
    pub t: f64,
    /// Ratio of tangential to normal force.
    pub ratio: f64,
    /// Direction of the tangential force, degrees; `None` if not known.
    pub direction: Option<f64>,
    /// Place of the contact on the fingertip, mm; `None` if not known.
    pub spot_mm: Option<(f64, f64)>,
}

/// Difference between a reading and those before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipJump {
    /// Time of the reading, s from an arbitrary origin.
    pub t: f64,
    /// Rise of the ratio of tangential to normal force.
    pub ratio: f64,
    /// Turn of the tangential force, degrees; `None` if the direction was not known.
    pub turn_deg: Option<f64>,
}

/// Finds slips on one fingertip. A rise counts if two readings in a row show it, so slips are detected one reading late.
#[derive(Debug, Clone)]
pub struct SlipDetector {
    ratio_jump: f64,
    turn_deg: f64,
    held: VecDeque<HeldMoment>,
    /// Ratio before the current creep.
    crept_from: Option<f64>,
    pending: Option<SlipJump>,
    /// Time of the last detected slip.
    last: Option<f64>,
    /// Time of the last jump of the ratio.
    jumped: Option<f64>,
}

impl SlipDetector {
    /// Creates a detector without history.
    pub fn new(thresholds: &GripThresholds) -> Self {
        Self {
            ratio_jump: thresholds.slip_ratio,
            turn_deg: thresholds.slip_turn_deg,
            held: VecDeque::new(),
            crept_from: None,
            pending: None,
            last: None,
            jumped: None,
        }
    }

    /// Uses other thresholds from now on.
    pub(super) const fn judge_by(&mut self, thresholds: &GripThresholds) {
        self.ratio_jump = thresholds.slip_ratio;
        self.turn_deg = thresholds.slip_turn_deg;
    }

    /// Time of the last detected slip, s; `None` before the first.
    pub const fn last(&self) -> Option<f64> {
        self.last
    }

    /// Adds the next reading. Returns the first and the second of two rises in a row.
    pub fn push(&mut self, now: HeldMoment) -> Option<(SlipJump, SlipJump)> {
        let jump = self.jump(&now);
        if self.held.len() >= READINGS_MAX {
            self.held.pop_front();
        }
        self.held.push_back(now);
        let crept = self.crept(&now);
        if jump.is_some() {
            self.jumped = Some(now.t);
        }
        let rise = jump.or(crept);
        let first = self.pending.take();
        self.pending = rise;
        let is_slip = now.ratio >= NEAR_FRICTION || self.slides(&now);
        let both = first.zip(rise).filter(|_| is_slip);
        if both.is_some() {
            self.last = Some(now.t);
        }
        both
    }

    /// True if the place of the contact moved.
    fn slides(&self, now: &HeldMoment) -> bool {
        let recent = self.held.iter().filter(|moment| moment.t >= now.t - SPOT_S);
        let mut places = recent.filter_map(|moment| moment.spot_mm);
        now.spot_mm
            .is_some_and(|(x, y)| places.any(|before| (x - before.0).hypot(y - before.1) > SPOT_MM))
    }

    /// Rise of a reading over those just before it. Readings of a slip in progress are left out of the reference.
    fn jump(&self, now: &HeldMoment) -> Option<SlipJump> {
        let is_recent = |moment: &&HeldMoment| moment.t >= now.t - BEFORE_S;
        let is_calm = |moment: &&HeldMoment| {
            self.last
                .is_none_or(|last| moment.t < last - APART_S || moment.t > last)
        };
        let before: Vec<&HeldMoment> = self.held.iter().filter(is_recent).filter(is_calm).collect();
        let rise = now.ratio - middle(&before)?;
        (rise >= self.ratio_jump).then(|| SlipJump {
            t: now.t,
            ratio: rise,
            turn_deg: turn(&before, now),
        })
    }

    /// Rise of the ratio since it began to creep, if it still creeps.
    fn crept(&mut self, now: &HeldMoment) -> Option<SlipJump> {
        // A jump sets a new level; the readings before it no longer count.
        let begins = self.jumped.unwrap_or(f64::NEG_INFINITY);
        let is_newer = |moment: &&HeldMoment| moment.t > now.t - BEFORE_S;
        let since = self.held.iter().filter(|moment| moment.t > begins);
        let (newer, older): (Vec<_>, Vec<_>) = since.partition(is_newer);
        let is_old = |moment: &&&HeldMoment| moment.t > now.t - 2.0 * BEFORE_S;
        let older: Vec<&HeldMoment> = older.iter().filter(is_old).copied().collect();
        let (newer_ratio, older_ratio) = (middle(&newer)?, middle(&older));
        let creeps = older_ratio.is_some_and(|older| newer_ratio - older >= CREEPS);
        if !creeps {
            self.crept_from = older_ratio;
            return None;
        }
        let from = *self.crept_from.get_or_insert(older_ratio?);
        let level: Vec<&HeldMoment> = newer.iter().rev().take(LEVEL_COUNT).copied().collect();
        let rise = middle(&level)? - from;
        let turn_deg = turn(&older, now);
        let turns = turn_deg.is_some_and(|turn| turn >= self.turn_deg);
        let share = if turns { TURNED_SHARE } else { 1.0 };
        (rise >= self.ratio_jump * share).then_some(SlipJump {
            t: now.t,
            ratio: rise,
            turn_deg,
        })
    }
}

/// Median ratio; `None` for too few readings.
fn middle(moments: &[&HeldMoment]) -> Option<f64> {
    let ratios: Vec<f64> = moments.iter().map(|moment| moment.ratio).collect();
    median(&ratios).filter(|_| moments.len() >= BEFORE_LEAST)
}

/// Angle between the current direction and the median of those before, degrees, the short way round.
fn turn(before: &[&HeldMoment], now: &HeldMoment) -> Option<f64> {
    let direction = now.direction?;
    let round = |degrees: f64| (degrees + 180.0).rem_euclid(360.0) - 180.0;
    let first = before.iter().find_map(|moment| moment.direction)?;
    let away: Vec<f64> = before
        .iter()
        .filter_map(|moment| Some(round(moment.direction? - first)))
        .collect();
    Some(round(direction - first - median(&away)?).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When slips were seen, s, on a fingertip that is read 30 times a second.
    fn slips(ratio: impl Fn(f64) -> f64, direction: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut detector = SlipDetector::new(&GripThresholds::default());
        let moments = (0..180).map(|n| f64::from(n) / 30.0);
        let seen = moments.filter(|t| {
            let moment = HeldMoment {
                t: *t,
                ratio: ratio(*t),
                direction: Some(direction(*t).rem_euclid(360.0)),
                spot_mm: None,
            };
            detector.push(moment).is_some()
        });
        seen.collect()
    }

    #[test]
    fn a_rise_of_friction_is_seen_before_it_is_over_however_slow_it_is() {
        for (rise, seconds) in [
            (0.2, 0.15),
            (0.4, 0.5),
            (0.2, 0.7),
            (0.2, 1.0),
            (0.2, 1.5),
            (0.5, 2.0),
            (0.2, 3.0),
        ] {
            let ratio = |t: f64| 0.2 + rise * ((t - 2.0) / seconds).clamp(0.0, 1.0);
            let seen = slips(ratio, |_| 10.0);
            let first = seen.first().copied().unwrap_or(f64::INFINITY);
            let in_time = (2.0..=2.0 + seconds).contains(&first);
            assert!(in_time, "{rise} in {seconds} s: {seen:?}");
            let last = seen.last().copied().unwrap_or_default();
            assert!(last < 2.0 + seconds + 0.8, "it holds again: {seen:?}");
        }
    }

    #[test]
    fn a_heavier_object_is_no_slip_unless_its_contact_moves() {
        let told = [false, true].map(|moves| {
            let mut detector = SlipDetector::new(&GripThresholds::default());
            let moments = (0..90).map(|n| f64::from(n) / 30.0);
            let mut moments = moments.map(|t| HeldMoment {
                t,
                ratio: 0.02 + 0.2 * ((t - 1.5) / 0.3).clamp(0.0, 1.0),
                direction: Some(10.0),
                spot_mm: Some((0.0, if moves { 4.0 * (t - 1.5).max(0.0) } else { 0.0 })),
            });
            moments.any(|moment| detector.push(moment).is_some())
        });
        assert_eq!(told, [false, true]);
    }

    #[test]
    fn a_turn_alone_a_bump_and_a_ratio_that_wanders_are_no_slip() {
        for seconds in [0.2, 0.8, 2.0] {
            let turns = |t: f64| 300.0 + 120.0 * ((t - 2.0) / seconds).clamp(0.0, 1.0);
            assert_eq!(slips(|_| 0.3, turns), [0.0; 0], "a turn in {seconds} s");
        }
        let bump = |t: f64| if (2.0..2.15).contains(&t) { 0.2 } else { 0.3 };
        assert_eq!(slips(bump, |_| 10.0), [0.0; 0]);
        let wanders = |t: f64| 0.3 + 0.05 * (1.3 * t).sin();
        assert_eq!(slips(wanders, |_| 10.0), [0.0; 0]);
        let shakes = |t: f64| 0.3 + 0.055 * (17.0 * t).sin();
        assert_eq!(slips(shakes, |_| 10.0), [0.0; 0]);
    }
}
