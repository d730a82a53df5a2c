//! Detection of touched fingertips for a reaction. Reads no clock and sends nothing.

use crate::hand::{Finger, Moment, PerFinger};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A fingertip counts as released after this time at low force, so that a trembling touch does not make the finger tremble.
const RELEASE_DURATION: Duration = Duration::from_millis(300);
/// Force is low below this share of the threshold.
const LET_GO_SHARE: f32 = 0.5;

/// Normal force of a fingertip, 0.1 to 20 N.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct TouchForce(f32);

/// A force outside the range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{got} N is outside 0.1 to 20")]
pub struct BadTouchForce {
    pub got: f32,
}

impl TouchForce {
    pub const fn newtons(self) -> f32 {
        self.0
    }
}

impl TryFrom<f32> for TouchForce {
    type Error = BadTouchForce;
    fn try_from(got: f32) -> Result<Self, BadTouchForce> {
        if (0.1..=20.0).contains(&got) {
            Ok(Self(got))
        } else {
            Err(BadTouchForce { got })
        }
    }
}

impl From<TouchForce> for f32 {
    fn from(force: TouchForce) -> Self {
        force.0
    }
}

/// Detects touches of the fingertips.
#[derive(Debug, Clone, PartialEq)]
pub struct TouchWatch {
    threshold: TouchForce,
    tips: PerFinger<TipWatch>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct TipWatch {
    /// Smallest reading since the start, newtons: the reading of the untouched fingertip.
    zero: Option<f32>,
    is_touched: bool,
    below_since: Option<Moment>,
}

impl TouchWatch {
    /// Starts without touches; the first reading of a fingertip is its zero.
    pub fn new(threshold: TouchForce) -> Self {
        Self {
            threshold,
            tips: PerFinger::from_fn(|_| TipWatch::default()),
        }
    }

    /// Applies the normal force of a fingertip, N. Returns `Some(true)` when it becomes touched, `Some(false)` when it is released.
    pub fn apply(&mut self, finger: Finger, newtons: f32, now: Moment) -> Option<bool> {
        let tip = &mut self.tips[finger];
        if !newtons.is_finite() {
            return None;
        }
        let zero = tip.zero.map_or(newtons, |zero| zero.min(newtons));
        tip.zero = Some(zero);
        let felt = newtons - zero;
        if felt >= self.threshold.newtons() {
            tip.below_since = None;
            return (!std::mem::replace(&mut tip.is_touched, true)).then_some(true);
        }
        if !tip.is_touched || felt >= self.threshold.newtons() * LET_GO_SHARE {
            tip.below_since = None;
            return None;
        }
        let since = *tip.below_since.get_or_insert(now);
        if now.since(since) < RELEASE_DURATION {
            return None;
        }
        tip.is_touched = false;
        Some(false)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    #[test]
    fn a_touch_counts_from_what_the_tip_felt_at_first_and_ends_after_a_while() {
        let mut watch = TouchWatch::new(TouchForce::try_from(0.5).unwrap());
        let mut take =
            |ms: u64, newtons| watch.apply(Finger::Index, newtons, Moment::from_micros(ms * 1000));
        assert_eq!(take(0, 2.0), None, "its zero, whatever it is");
        assert_eq!(take(20, 2.4), None);
        assert_eq!(take(40, f32::NAN), None);
        assert_eq!(take(60, 2.5), Some(true));
        assert_eq!(take(80, 9.0), None, "once");
        assert_eq!(take(100, 2.3), None, "not let go");
        assert_eq!(take(120, 2.1), None);
        assert_eq!(take(300, 2.6), None, "touched again meanwhile");
        assert_eq!(take(320, 2.0), None);
        assert_eq!(take(619, 2.0), None);
        assert_eq!(take(620, 2.0), Some(false));
        assert_eq!(take(640, 1.0), None, "it was touched at the start");
        assert_eq!(take(660, 1.5), Some(true));
    }
}
