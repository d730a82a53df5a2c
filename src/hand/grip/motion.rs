//! Motion of a joint, detected from its angle and the status of its drive.

use crate::hand::feedback::status::Status;
use crate::hand::moment::Moment;
use std::collections::VecDeque;
use std::time::Duration;

/// Angles read within this time of each other are merged.
const STEP: Duration = Duration::from_millis(8);
/// A joint moves if its angle changed by more than [`FAST_UNITS`] within this time.
const FAST: Duration = Duration::from_millis(100);
const FAST_UNITS: i16 = 3;
/// A drive that reports motion does not move if its angle changed by less than [`SLOW_UNITS`] within this time: it pushes.
const SLOW: Duration = Duration::from_millis(500);
const SLOW_UNITS: i16 = 2;
/// Capacity of the angle history: [`SLOW`] divided by [`STEP`], with some reserve.
const ANGLES_MAX: usize = 80;

/// Angles of one joint over the last half second.
#[derive(Debug, Clone, Default)]
pub(super) struct JointMotion {
    angles: VecDeque<(Moment, i16)>,
    began: Option<Moment>,
}

impl JointMotion {
    /// Adds an angle, 0..=1000, with the time at which it was read.
    pub(super) fn push(&mut self, at: Moment, angle: i16) {
        self.began.get_or_insert(at);
        if let Some((newest, known)) = self.angles.back_mut()
            && at.since(*newest) < STEP
        {
            *known = angle;
            return;
        }
        while self.angles.len() >= ANGLES_MAX
            || self
                .angles
                .front()
                .is_some_and(|(first, _)| at.since(*first) > SLOW)
        {
            self.angles.pop_front();
        }
        self.angles.push_back((at, angle));
    }

    /// Returns true if the joint moves at time `at`.
    pub(super) fn is_moving(&self, at: Moment, status: Status) -> bool {
        if self.range(at, FAST) > FAST_UNITS {
            return true;
        }
        let is_known = self.began.is_some_and(|began| at.since(began) >= SLOW);
        status.is_moving() && (!is_known || self.range(at, SLOW) >= SLOW_UNITS)
    }

    fn range(&self, at: Moment, within: Duration) -> i16 {
        let recent = self.angles.iter().rev();
        let recent = recent.take_while(|(then, _)| at.since(*then) <= within);
        let (low, high) = recent.fold((i16::MAX, i16::MIN), |(low, high), (_, angle)| {
            (low.min(*angle), high.max(*angle))
        });
        high.saturating_sub(low).max(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(units_a_second: f64, status: Status) -> bool {
        let mut motion = JointMotion::default();
        let at = |n: u32| Moment::from_duration(Duration::from_millis(10) * n);
        for n in 0..100 {
            #[expect(clippy::cast_possible_truncation, reason = "at most 1000")]
            let angle = (900.0 - units_a_second * f64::from(n) * 0.01).round() as i16;
            motion.push(at(n), angle);
        }
        motion.is_moving(at(99), status)
    }

    #[test]
    fn a_fast_joint_moves_whatever_its_drive_says_and_a_slow_one_if_it_says_so() {
        for (speed, status, moves) in [
            (200.0, Status::ForceReached, true),
            (10.0, Status::Grasping, true),
            (10.0, Status::PositionReached, false),
            (0.0, Status::Releasing, false),
            (0.0, Status::PositionReached, false),
        ] {
            assert_eq!(seen(speed, status), moves, "{speed} {status:?}");
        }
    }

    #[test]
    fn what_a_drive_says_counts_before_its_angle_is_known_for_long() {
        let mut motion = JointMotion::default();
        motion.push(Moment::ZERO, 700);
        assert!(motion.is_moving(Moment::ZERO, Status::Grasping));
        assert!(!motion.is_moving(Moment::ZERO, Status::PositionReached));
    }
}
