//! Slips of a held object: jumps of friction or of the tangential force's direction, reading by reading.

use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::statistics::median;
use std::collections::VecDeque;

/// Normal force below which there is nothing to slip, N.
pub const HELD_N: f64 = 0.2;
/// The reference: the median of this many seconds before.
const BEFORE_S: f64 = 0.5;
/// Slips nearer to each other than this are one.
pub const APART_S: f64 = 0.4;
/// Values that are needed before a jump can be told.
pub const BEFORE_LEAST: usize = 3;
/// Moments that are kept: half a second of a sensor that is read 500 times a second.
const KEPT_MAX: usize = 256;

/// One moment of holding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldMoment {
    /// When it was read, s from whenever.
    pub t: f64,
    /// Tangential by normal force.
    pub ratio: f64,
    /// Degrees of the tangential force; `None` if not known.
    pub direction: Option<f64>,
}

/// How a moment differs from those before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipJump {
    /// When it was read, s from whenever.
    pub t: f64,
    /// Rise of tangential by normal force.
    pub ratio: f64,
    /// Turn of the tangential force, degrees; `None` if the direction was not known.
    pub turn_deg: Option<f64>,
}

/// Finds slips on one fingertip. A jump counts if two readings in a row show it, so slips are seen one reading late.
#[derive(Debug, Clone)]
pub struct SlipDetector {
    ratio_jump: f64,
    turn_deg: f64,
    held: VecDeque<HeldMoment>,
    pending: Option<SlipJump>,
    /// When it was last seen to slip.
    last: Option<f64>,
}

impl SlipDetector {
    /// One that has seen nothing.
    pub fn new(thresholds: &GripThresholds) -> Self {
        Self {
            ratio_jump: thresholds.slip_ratio,
            turn_deg: thresholds.slip_turn_deg,
            held: VecDeque::new(),
            pending: None,
            last: None,
        }
    }

    /// Judges by other thresholds from now on.
    pub(super) const fn judge_by(&mut self, thresholds: &GripThresholds) {
        self.ratio_jump = thresholds.slip_ratio;
        self.turn_deg = thresholds.slip_turn_deg;
    }

    /// When it was last seen to slip, s.
    pub const fn last(&self) -> Option<f64> {
        self.last
    }

    /// Takes the next moment of holding. Gives the first and the second of two jumps in a row.
    pub fn take(&mut self, now: HeldMoment) -> Option<(SlipJump, SlipJump)> {
        let jump = self.jump(&now);
        if self.held.len() >= KEPT_MAX {
            self.held.pop_front();
        }
        self.held.push_back(now);
        let first = self.pending.take();
        self.pending = jump;
        let both = first.zip(jump);
        if both.is_some() {
            self.last = Some(now.t);
        }
        both
    }

    /// How a moment differs from those before it. Moments of a slip that is going on are no measure.
    fn jump(&self, now: &HeldMoment) -> Option<SlipJump> {
        let is_recent = |moment: &&HeldMoment| moment.t >= now.t - BEFORE_S;
        let is_calm = |moment: &&HeldMoment| {
            self.last
                .is_none_or(|last| moment.t < last - APART_S || moment.t > last)
        };
        let before: Vec<&HeldMoment> = self.held.iter().filter(is_recent).filter(is_calm).collect();
        if before.len() < BEFORE_LEAST {
            return None;
        }
        let ratios: Vec<f64> = before.iter().map(|moment| moment.ratio).collect();
        let ratio = now.ratio - median(&ratios)?;
        let turn_deg = turn(&before, now);
        let is_slip =
            ratio >= self.ratio_jump || turn_deg.is_some_and(|turn| turn >= self.turn_deg);
        is_slip.then_some(SlipJump {
            t: now.t,
            ratio,
            turn_deg,
        })
    }
}

/// Degrees between a direction and the middle of those before, the short way round.
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
