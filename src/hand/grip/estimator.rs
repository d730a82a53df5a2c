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
/// use handscope::hand::grip::{GripEstimator, GripState, GripThresholds};
/// use handscope::hand::{Groups, HandSample, Moment};
///
/// let mut estimator = GripEstimator::new(GripThresholds::default());
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

    /// The thresholds in force.
    pub const fn thresholds(&self) -> &GripThresholds {
        &self.thresholds
    }

    /// Tells by other thresholds from the next reading on. What was seen so far is kept.
    pub fn set_thresholds(&mut self, thresholds: GripThresholds) {
        self.thresholds = thresholds;
        for (_, finger) in self.fingers.iter_mut() {
            finger.set_thresholds(&thresholds);
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

    /// What needs a person comes first; a grasp holds once no finger is on its way.
    fn grasp_state(&self, fingers: &PerFinger<GripEstimate>) -> GripState {
        let count = |state: GripState| {
            let states = fingers.as_array().iter().map(|finger| finger.state);
            states.filter(|of_finger| *of_finger == state).count()
        };
        let has = |state| count(state) > 0;
        let holds = count(GripState::Holding) >= usize::from(self.thresholds.least_fingers);
        match () {
            () if has(GripState::TooHard) => GripState::TooHard,
            () if has(GripState::Slipping) => GripState::Slipping,
            () if has(GripState::Lost) && !holds => GripState::Lost,
            () if has(GripState::Moving) => GripState::Moving,
            () if holds => GripState::Holding,
            () if has(GripState::Unknown) => GripState::Unknown,
            () if has(GripState::Empty) || has(GripState::Holding) => GripState::Empty,
            () => GripState::Open,
        }
    }
}
