//! Estimates the grip of a whole hand, reading by reading.

use crate::hand::dof::PerFinger;
use crate::hand::feedback::group::Groups;
use crate::hand::feedback::sample::HandSample;
use crate::hand::grip::evidence::{FingerEvidence, ReadingAt};
use crate::hand::grip::finger::{FingerContext, FingerEstimator};
use crate::hand::grip::free::FreeForce;
use crate::hand::grip::state::{Grip, GripEstimate, GripState};
use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::moment::Moment;

/// Estimator of the grip of one hand. It receives each reading with its time; the same readings give the same states.
///
/// ```
/// use handscope_core::hand::grip::{GripEstimator, GripState};
/// use handscope_core::hand::{Groups, HandSample, Moment};
///
/// let mut estimator = GripEstimator::default();
/// let grip = estimator.apply(&HandSample::default(), Groups::default(), Moment::ZERO);
/// assert_eq!(grip.grasp.state, GripState::Unknown);
/// ```
#[derive(Debug, Clone)]
pub struct GripEstimator {
    thresholds: GripThresholds,
    fingers: PerFinger<FingerEstimator>,
    grasp: GripEstimate,
    free: FreeForce,
    /// Number of closes from which it learned something.
    learned: u64,
}

impl Default for GripEstimator {
    fn default() -> Self {
        Self::new(GripThresholds::default())
    }
}

impl GripEstimator {
    /// Creates an estimator without history.
    pub fn new(thresholds: GripThresholds) -> Self {
        Self {
            thresholds,
            fingers: PerFinger::from_fn(|_| FingerEstimator::new(&thresholds)),
            grasp: GripEstimate::default(),
            free: FreeForce::default(),
            learned: 0,
        }
    }

    /// Creates an estimator that knows the free-motion forces of this hand's joints.
    pub fn knowing(free: FreeForce) -> Self {
        Self {
            free,
            ..Self::default()
        }
    }

    /// Replaces the known free-motion forces of this hand's joints.
    pub const fn set_free_force(&mut self, free: FreeForce) {
        self.free = free;
    }

    /// Free-motion forces known so far; each close that touches nothing improves them.
    pub const fn free_force(&self) -> &FreeForce {
        &self.free
    }

    /// Number of closes that changed the known free-motion forces; when it rises, they are worth saving again.
    pub const fn learned(&self) -> u64 {
        self.learned
    }

    /// Thresholds in use.
    pub const fn thresholds(&self) -> GripThresholds {
        self.thresholds
    }

    /// Uses other thresholds from now on. The learned forces and the history stay.
    pub fn judge_by(&mut self, thresholds: GripThresholds) {
        if self.thresholds == thresholds {
            return;
        }
        self.thresholds = thresholds;
        for (_, finger) in self.fingers.iter_mut() {
            finger.judge_by(&thresholds);
        }
    }

    /// Updates the grip with a sample read at `at`, in which the groups `fresh` are new, and returns it.
    pub fn apply(&mut self, sample: &HandSample, fresh: Groups, at: Moment) -> Grip {
        let reading = ReadingAt {
            at,
            fresh,
            fresh_for: self.thresholds.fresh_for(),
        };
        let evidence = PerFinger::from_fn(|finger| FingerEvidence::of(sample, finger, reading));
        let is_free = |own: &Option<FingerEvidence>| {
            let own = own.as_ref();
            own.is_some_and(|own| own.tip.is_some() && own.is_tip_free(&self.thresholds))
        };
        let scene = FingerContext {
            at,
            thresholds: &self.thresholds,
            free: &self.free,
            is_hand_free: evidence.as_array().iter().all(is_free),
        };
        for (finger, estimator) in self.fingers.iter_mut() {
            match &evidence[finger] {
                Some(evidence) => estimator.apply(evidence, scene),
                None => estimator.forget(at, &self.thresholds),
            }
        }
        self.learn();
        let fingers = PerFinger::from_fn(|finger| self.fingers[finger].estimate);
        let is_known = |finger: &GripEstimate| finger.state != GripState::Unknown;
        let known = fingers.as_array().iter().filter(|finger| is_known(finger));
        let asked = known.filter_map(|finger| finger.asked).min();
        let state = self.grasp_state(&fingers);
        let asked = asked.or(self.grasp.asked);
        self.grasp.become_state(state, at, asked);
        self.grip()
    }

    /// Merges the measurements of closes that touched nothing.
    fn learn(&mut self) {
        let mut is_news = false;
        for (_, finger) in self.fingers.iter_mut() {
            for (dof, close) in finger.learned.drain(..) {
                is_news |= self.free.learn(dof, &close);
            }
        }
        self.learned += u64::from(is_news);
    }

    /// Grip as of the newest reading.
    pub fn grip(&self) -> Grip {
        Grip {
            fingers: PerFinger::from_fn(|finger| self.fingers[finger].estimate),
            grasp: self.grasp,
            fresh_for: self.thresholds.fresh_for(),
        }
    }

    /// Grip at time `now`; unknown if `is_believed` is false.
    pub fn known(&self, is_believed: bool, now: Moment) -> Grip {
        if is_believed {
            self.grip().at(now)
        } else {
            Grip::default()
        }
    }

    /// States that need the user's attention come first; a grasp holds once no finger is in motion.
    fn grasp_state(&self, fingers: &PerFinger<GripEstimate>) -> GripState {
        let count = |state: GripState| {
            let states = fingers.as_array().iter().map(|finger| finger.state);
            states.filter(|of_finger| *of_finger == state).count()
        };
        let has = |state| count(state) > 0;
        let holding = count(GripState::Holding);
        let holds = holding >= usize::from(self.thresholds.least_fingers);
        match () {
            () if has(GripState::Slipping) => GripState::Slipping,
            () if has(GripState::TooHard) => GripState::TooHard,
            () if has(GripState::Lost) && !holds => GripState::Lost,
            () if has(GripState::Moving) => GripState::Moving,
            () if holds && holding == 1 => GripState::Touching,
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

        /// State of the index finger after this time.
        fn after(&mut self, ms: u64) -> GripState {
            for _ in 0..ms / 10 {
                self.ms += 10;
                let at = Moment::from_micros(self.ms * 1000);
                let (sample, fresh) = self.sample(at);
                self.estimator.apply(&sample, fresh, at);
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
            for finger in Finger::ALL {
                let pressed = self
                    .normal_n
                    .map(|n| if finger == Finger::Index { n } else { 0.0 });
                sample.tactile[finger] =
                    pressed.and_then(|normal_n| timed(TactileBlock { normal_n, ..block }, at));
            }
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
        let grip = hand.estimator.apply(&sample, Groups::default(), at);
        assert_eq!(grip.grasp.state, GripState::Unknown);
        assert_eq!(
            grip.fingers[Finger::Index].age(at),
            Some(Duration::from_millis(600))
        );
        hand.normal_n = Some(0.0);
        let states = hand.after(600);
        assert_eq!(
            states,
            GripState::Unknown,
            "force stopped it, from a zero that is not known"
        );
        hand.status = Status::PositionReached;
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

    /// The index bends to 240 in the air, against this friction, and rests; returns the reported states.
    #[expect(clippy::cast_possible_truncation, reason = "at most 100 g")]
    fn close_in_the_air(hand: &mut Reading, friction_g: i16) -> Vec<GripState> {
        hand.status = Status::Grasping;
        let mut states = Vec::new();
        for angle in (240..1000).rev().step_by(10) {
            hand.angle = angle;
            let share = f32::from(1000 - angle) / 760.0;
            hand.force_g = 230 + (share * f32::from(friction_g)) as i16;
            states.push(hand.after(10));
        }
        hand.status = Status::PositionReached;
        states.extend((0..100).map(|_| hand.after(10)));
        states
    }

    fn open_again(hand: &mut Reading) {
        hand.status = Status::Releasing;
        (hand.angle, hand.force_g) = (600, 230);
        hand.after(100);
        (hand.angle, hand.status) = (1000, Status::PositionReached);
        assert_eq!(hand.after(500), GripState::Open);
    }

    #[test]
    fn friction_in_the_air_is_never_holding_and_is_learnt_by_the_close() {
        let mut hand = Reading::new(Some(0.0));
        assert_eq!(hand.after(200), GripState::Open);
        let states = close_in_the_air(&mut hand, 87);
        assert!(!states.contains(&GripState::Holding), "{states:?}");
        let rests = states.last().copied().unwrap();
        assert_eq!(rests, GripState::Unknown, "no close excuses itself");
        open_again(&mut hand);
        assert!(hand.estimator.learned() > 0);
        let states = close_in_the_air(&mut hand, 87);
        assert!(!states.contains(&GripState::Holding), "{states:?}");
        assert_eq!(states.last(), Some(&GripState::Empty), "it knows it now");
        hand.force_g = 900;
        assert_eq!(hand.after(100), GripState::Holding, "by its side");
        open_again(&mut hand);
        // Another program begins with what this one learnt.
        let free = *hand.estimator.free_force();
        hand.estimator = GripEstimator::knowing(free);
        assert_eq!(hand.after(200), GripState::Open);
        let states = close_in_the_air(&mut hand, 87);
        assert_eq!(states.last(), Some(&GripState::Empty));
    }

    #[test]
    fn a_close_that_touched_something_teaches_nothing() {
        let mut hand = Reading::new(Some(0.0));
        assert_eq!(hand.after(200), GripState::Open);
        close_in_the_air(&mut hand, 87);
        hand.normal_n = Some(1.0);
        assert_eq!(hand.after(100), GripState::Holding);
        hand.normal_n = Some(0.0);
        open_again(&mut hand);
        assert_eq!(hand.estimator.learned(), 0);
    }

    #[test]
    fn what_is_lost_is_told_however_far_the_zero_of_the_force_drifted_meanwhile() {
        for drift_g in [-100, -45, 0, 25, 45, 60, 75, 100] {
            let mut hand = Reading::new(Some(0.0));
            assert_eq!(hand.after(200), GripState::Open);
            (hand.angle, hand.status) = (400, Status::ForceReached);
            (hand.normal_n, hand.force_g) = (Some(3.0), 530);
            assert_eq!(hand.after(300), GripState::Holding);
            hand.force_g += drift_g;
            assert_eq!(hand.after(1000), GripState::Holding, "{drift_g}");
            (hand.normal_n, hand.force_g) = (Some(0.0), 230 + drift_g);
            assert_eq!(hand.after(100), GripState::Lost, "{drift_g}");
            assert_eq!(hand.after(5000), GripState::Lost, "{drift_g}");
        }
    }

    #[test]
    fn a_fingertip_that_falls_silent_under_a_strong_grip_leaves_it_unknown() {
        let mut hand = Reading::new(Some(0.0));
        assert_eq!(hand.after(200), GripState::Open);
        (hand.angle, hand.status) = (400, Status::ForceReached);
        (hand.normal_n, hand.force_g) = (Some(6.0), 830);
        assert_eq!(hand.after(300), GripState::Holding);
        hand.normal_n = Some(0.0);
        assert_eq!(hand.after(200), GripState::Unknown);
    }

    #[test]
    fn a_finger_that_closed_on_something_large_holds_it_without_its_threshold() {
        let mut hand = Reading::new(Some(5.0));
        (hand.angle, hand.status) = (930, Status::PositionReached);
        assert_eq!(hand.after(300), GripState::Open, "the user touches it");
        hand.status = Status::ForceReached;
        assert_eq!(hand.after(300), GripState::Holding);
        for angle in [930, 928, 931] {
            (hand.angle, hand.status) = (angle, Status::PositionReached);
            assert_eq!(hand.after(500), GripState::Holding, "at {angle}");
        }
        hand.status = Status::Releasing;
        hand.after(50);
        hand.status = Status::PositionReached;
        assert_eq!(hand.after(300), GripState::Open, "let go, and touched");
    }

    #[test]
    fn one_finger_alone_touches_and_a_pinch_holds_with_two_fingers_only() {
        let mut hand = Reading::new(Some(5.0));
        (hand.angle, hand.status) = (400, Status::ForceReached);
        assert_eq!(hand.after(300), GripState::Holding);
        let touching = hand.estimator.grip().grasp.state;
        assert_eq!(touching, GripState::Touching);
        assert!(touching.is_still() && touching.is_held());
        let pinch = GripThresholds {
            least_fingers: 2,
            ..GripThresholds::default()
        };
        hand.estimator = GripEstimator::new(pinch);
        assert_eq!(hand.after(300), GripState::Holding);
        assert_eq!(hand.estimator.grip().grasp.state, GripState::Empty);
    }
}
