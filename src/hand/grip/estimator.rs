//! The grip of a whole hand, reading by reading.

use crate::hand::dof::PerFinger;
use crate::hand::feedback::group::Groups;
use crate::hand::feedback::sample::HandSample;
use crate::hand::grip::evidence::{FingerEvidence, ReadingAt};
use crate::hand::grip::finger::FingerEstimator;
use crate::hand::grip::state::{Grip, GripEstimate, GripState};
use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::moment::Moment;

/// Follows the grip of one hand. It is given each reading with its moment; the same readings give the same states.
///
/// ```
/// use handscope::hand::grip::{GripEstimator, GripState};
/// use handscope::hand::{Groups, HandSample, Moment};
///
/// let mut estimator = GripEstimator::default();
/// let grip = estimator.take(&HandSample::default(), Groups::default(), Moment::ZERO);
/// assert_eq!(grip.grasp.state, GripState::Unknown);
/// ```
#[derive(Debug, Clone)]
pub struct GripEstimator {
    thresholds: GripThresholds,
    fingers: PerFinger<FingerEstimator>,
    grasp: GripEstimate,
}

impl Default for GripEstimator {
    fn default() -> Self {
        Self::new(GripThresholds::default())
    }
}

impl GripEstimator {
    /// One that has seen nothing.
    pub fn new(thresholds: GripThresholds) -> Self {
        Self {
            thresholds,
            fingers: PerFinger::from_fn(|_| FingerEstimator::new(&thresholds)),
            grasp: GripEstimate::default(),
        }
    }

    /// What it judges by.
    pub const fn thresholds(&self) -> GripThresholds {
        self.thresholds
    }

    /// Judges by other thresholds from now on. What it knows of the hand stays.
    pub fn judge_by(&mut self, thresholds: GripThresholds) {
        if self.thresholds == thresholds {
            return;
        }
        self.thresholds = thresholds;
        for (_, finger) in self.fingers.iter_mut() {
            finger.judge_by(&thresholds);
        }
    }

    /// Takes what was read at `at`, where `fresh` is new in it, and tells the grip.
    pub fn take(&mut self, sample: &HandSample, fresh: Groups, at: Moment) -> Grip {
        let reading = ReadingAt {
            at,
            fresh,
            fresh_for: self.thresholds.fresh_for(),
        };
        for (finger, estimator) in self.fingers.iter_mut() {
            match FingerEvidence::of(sample, finger, reading) {
                Some(evidence) => estimator.take(&evidence, at, &self.thresholds),
                None => estimator.forget(at, &self.thresholds),
            }
        }
        let fingers = PerFinger::from_fn(|finger| self.fingers[finger].estimate);
        let is_known = |finger: &GripEstimate| finger.state != GripState::Unknown;
        let known = fingers.as_array().iter().filter(|finger| is_known(finger));
        let asked = known.filter_map(|finger| finger.asked).min();
        let state = self.grasp_state(&fingers);
        let asked = asked.or(self.grasp.asked);
        self.grasp.become_state(state, at, asked);
        self.grip()
    }

    /// The grip as of the newest reading.
    pub fn grip(&self) -> Grip {
        Grip {
            fingers: PerFinger::from_fn(|finger| self.fingers[finger].estimate),
            grasp: self.grasp,
            fresh_for: self.thresholds.fresh_for(),
        }
    }

    /// The grip as it is known at `now`; unknown where readings are not believed.
    pub fn known(&self, is_believed: bool, now: Moment) -> Grip {
        if is_believed {
            self.grip().at(now)
        } else {
            Grip::default()
        }
    }

    /// What needs the user comes first; a grasp holds once no finger is on its way.
    fn grasp_state(&self, fingers: &PerFinger<GripEstimate>) -> GripState {
        let count = |state: GripState| {
            let states = fingers.as_array().iter().map(|finger| finger.state);
            states.filter(|of_finger| *of_finger == state).count()
        };
        let has = |state| count(state) > 0;
        let holds = count(GripState::Holding) >= usize::from(self.thresholds.least_fingers);
        match () {
            () if has(GripState::Slipping) => GripState::Slipping,
            () if has(GripState::TooHard) => GripState::TooHard,
            () if has(GripState::Lost) && !holds => GripState::Lost,
            () if has(GripState::Moving) => GripState::Moving,
            () if holds => GripState::Holding,
            () if has(GripState::Unknown) => GripState::Unknown,
            () if has(GripState::Empty) || has(GripState::Holding) => GripState::Empty,
            () => GripState::Open,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::dof::{Dof, Finger, PerDof};
    use crate::hand::feedback::reading::{AngleReading, ForceReading};
    use crate::hand::feedback::status::Status;
    use crate::hand::feedback::tactile::TactileBlock;
    use crate::hand::moment::Timed;
    use std::time::Duration;

    /// A hand at rest that is read each 10 ms; its index finger is what matters.
    struct Reading {
        ms: u64,
        angle: i16,
        force_g: i16,
        status: Status,
        normal_n: Option<f32>,
        estimator: GripEstimator,
    }

    impl Reading {
        fn new(normal_n: Option<f32>) -> Self {
            Self {
                ms: 0,
                angle: 1000,
                force_g: 230,
                status: Status::PositionReached,
                normal_n,
                estimator: GripEstimator::default(),
            }
        }

        /// The state of the index finger after so long.
        fn after(&mut self, ms: u64) -> GripState {
            for _ in 0..ms / 10 {
                self.ms += 10;
                let at = Moment::from_micros(self.ms * 1000);
                let (sample, fresh) = self.sample(at);
                self.estimator.take(&sample, fresh, at);
            }
            self.estimator.grip().fingers[Finger::Index].state
        }

        fn sample(&self, at: Moment) -> (HandSample, Groups) {
            fn timed<T>(value: T, at: Moment) -> Option<Timed<T>> {
                Some(Timed {
                    value,
                    asked: at,
                    received: at,
                })
            }
            let six = |of_index: i16, others: i16| {
                PerDof::from_fn(|dof| if dof == Dof::Index { of_index } else { others })
            };
            let mut sample = HandSample {
                angle: timed(six(self.angle, 1000).map(AngleReading::new), at),
                force: timed(six(self.force_g, 0).map(ForceReading::new), at),
                status: timed(PerDof::splat(self.status), at),
                ..HandSample::default()
            };
            let block = TactileBlock::decode(&[0; 58]).unwrap();
            sample.tactile[Finger::Index] = self
                .normal_n
                .and_then(|normal_n| timed(TactileBlock { normal_n, ..block }, at));
            let fresh = crate::hand::Group::ALL.into_iter().collect();
            (sample, fresh)
        }
    }

    #[test]
    fn force_alone_tells_once_its_zero_was_learnt_at_the_open_finger() {
        let mut hand = Reading::new(None);
        assert_eq!(hand.after(200), GripState::Open);
        (hand.angle, hand.status) = (400, Status::ForceReached);
        assert_eq!(hand.after(300), GripState::Empty, "230 g is its zero");
        hand.force_g = 530;
        assert_eq!(hand.after(50), GripState::Holding);
        hand.force_g = 231;
        assert_eq!(
            hand.after(30),
            GripState::Holding,
            "for a moment it may be noise"
        );
        assert_eq!(hand.after(30), GripState::Lost);
        hand.angle = 900;
        assert_eq!(hand.after(200), GripState::Open, "and not lost any more");
    }

    #[test]
    fn a_closed_finger_without_fingertip_and_zero_is_unknown() {
        let mut hand = Reading::new(None);
        (hand.angle, hand.status) = (400, Status::ForceReached);
        assert_eq!(hand.after(600), GripState::Unknown);
        hand.normal_n = Some(3.0);
        assert_eq!(hand.after(50), GripState::Holding);
        hand.normal_n = Some(0.0);
        assert_eq!(hand.after(100), GripState::Lost);
    }

    #[test]
    fn opening_loses_nothing_and_pressing_hard_is_told() {
        let mut hand = Reading::new(Some(0.0));
        assert_eq!(hand.after(200), GripState::Open);
        (hand.angle, hand.status) = (400, Status::ForceReached);
        (hand.normal_n, hand.force_g) = (Some(22.0), 2500);
        assert_eq!(hand.after(300), GripState::TooHard);
        (hand.normal_n, hand.force_g) = (Some(5.0), 740);
        assert_eq!(hand.after(50), GripState::Holding);
        hand.status = Status::Releasing;
        (hand.angle, hand.normal_n, hand.force_g) = (405, Some(0.0), 230);
        assert_eq!(hand.after(50), GripState::Moving);
        (hand.angle, hand.status) = (950, Status::PositionReached);
        assert_eq!(hand.after(300), GripState::Open);
    }

    #[test]
    fn what_is_old_is_no_evidence_and_what_was_held_is_not_taken_for_lost() {
        let mut hand = Reading::new(Some(5.0));
        (hand.angle, hand.status) = (400, Status::ForceReached);
        assert_eq!(hand.after(300), GripState::Holding);
        let (sample, _) = hand.sample(Moment::from_micros(hand.ms * 1000));
        hand.ms += 600;
        let at = Moment::from_micros(hand.ms * 1000);
        let grip = hand.estimator.take(&sample, Groups::default(), at);
        assert_eq!(grip.grasp.state, GripState::Unknown);
        assert_eq!(
            grip.fingers[Finger::Index].age(at),
            Some(Duration::from_millis(600))
        );
        hand.normal_n = Some(0.0);
        assert_eq!(hand.after(600), GripState::Empty);
    }

    #[test]
    fn other_thresholds_count_from_then_on_and_what_was_learnt_stays() {
        let mut hand = Reading::new(None);
        assert_eq!(hand.after(200), GripState::Open);
        (hand.angle, hand.status, hand.force_g) = (400, Status::ForceReached, 270);
        assert_eq!(hand.after(300), GripState::Empty, "40 g over its zero");
        hand.estimator.judge_by(GripThresholds {
            contact_g: 30,
            ..GripThresholds::default()
        });
        assert_eq!(hand.after(100), GripState::Holding);
        hand.estimator.judge_by(GripThresholds::default());
        hand.force_g = 231;
        assert_eq!(hand.after(100), GripState::Lost);
    }

    #[test]
    fn a_pinch_holds_with_two_fingers_only() {
        let mut hand = Reading::new(Some(5.0));
        (hand.angle, hand.status) = (400, Status::ForceReached);
        assert_eq!(hand.after(300), GripState::Holding);
        assert_eq!(hand.estimator.grip().grasp.state, GripState::Holding);
        let pinch = GripThresholds {
            least_fingers: 2,
            ..GripThresholds::default()
        };
        hand.estimator = GripEstimator::new(pinch);
        assert_eq!(hand.after(300), GripState::Holding);
        assert_eq!(hand.estimator.grip().grasp.state, GripState::Empty);
    }
}
