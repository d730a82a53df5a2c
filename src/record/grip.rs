//! The grip of the hand that entries tell of: the same for a file, a viewer, DDS and a table.

use crate::hand::Moment;
use crate::hand::grip::{Grip, GripEstimator, GripState};
use crate::record::{Entry, LinkReport, Record};
use serde::Deserialize;

/// Follows the grip entry after entry.
#[derive(Debug, Clone, Default)]
pub(crate) struct GripFollower {
    estimator: GripEstimator,
    /// Feedback does not follow what the hand was told, since then.
    doubted: Option<Moment>,
}

/// What counts of a status of the link.
#[derive(Deserialize)]
struct Doubt {
    #[serde(default)]
    feedback_in_doubt: bool,
}

impl GripFollower {
    /// Takes an entry. The grip after it, if it is a reading or the end of them.
    pub(crate) fn take(&mut self, entry: &Entry) -> Option<Grip> {
        match entry {
            Entry::Heard(Record::Reading { sample, fresh }) => {
                let at = entry.at();
                let grip = self.estimator.take(sample, *fresh, at).at(at);
                Some(self.doubted.map_or(grip, Grip::unknown))
            }
            Entry::Heard(Record::State { at, state }) if !state.is_live() => {
                *self = Self::default();
                Some(Grip::unknown(*at))
            }
            Entry::Link(report) => {
                self.report(report);
                None
            }
            Entry::Heard(_) | Entry::Wire(_) | Entry::Event(_) => None,
        }
    }

    /// A status that did not change is not told.
    fn report(&mut self, report: &LinkReport) {
        if let Ok(status) = serde_json::from_str::<Doubt>(&report.status) {
            let is_new = self.doubted.is_none();
            self.doubted = match status.feedback_in_doubt {
                true if is_new => Some(report.at),
                true => self.doubted,
                false => None,
            };
        }
    }
}

/// The state of the grasp, then of each finger.
pub(crate) fn states(grip: &Grip) -> [GripState; 6] {
    let [little, ring, middle, index, thumb] = *grip.fingers.map(|own| own.state).as_array();
    [grip.grasp.state, little, ring, middle, index, thumb]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::dof::{PerDof, PerFinger};
    use crate::hand::feedback::tactile::TactileBlock;
    use crate::hand::{AngleReading, ForceReading, Group, HandSample, Status, Timed};
    use crate::record::LinkState;
    use std::sync::Arc;

    /// All fingers closed, at rest and pressing.
    fn reading(at: Moment) -> Entry {
        fn timed<T>(value: T, at: Moment) -> Option<Timed<T>> {
            Some(Timed {
                value,
                asked: at,
                received: at,
            })
        }
        let block = TactileBlock::decode(&[0; 58]).unwrap();
        let pressed = TactileBlock {
            normal_n: 5.0,
            ..block
        };
        let sample = HandSample {
            angle: timed(PerDof::splat(AngleReading::new(400)), at),
            force: timed(PerDof::splat(ForceReading::new(500)), at),
            status: timed(PerDof::splat(Status::ForceReached), at),
            tactile: PerFinger::from_fn(|_| timed(pressed, at)),
            ..HandSample::default()
        };
        Entry::Heard(Record::Reading {
            sample: Arc::new(sample),
            fresh: Group::ALL.into_iter().collect(),
        })
    }

    #[test]
    fn a_grip_is_unknown_while_feedback_is_in_doubt_and_once_the_link_is_gone() {
        let mut follower = GripFollower::default();
        let mut ms = 0;
        let mut held = |follower: &mut GripFollower| {
            let mut states = [GripState::Unknown; 6];
            for _ in 0..50 {
                ms += 10;
                let entry = reading(Moment::from_micros(ms * 1000));
                states = super::states(&follower.take(&entry).unwrap());
            }
            states
        };
        assert_eq!(held(&mut follower), [GripState::Holding; 6]);
        let report = |status: &str| {
            Entry::Link(LinkReport {
                at: Moment::ZERO,
                state: LinkState::Armed,
                trouble: String::new(),
                status: status.into(),
                figures: String::new(),
            })
        };
        follower.take(&report(r#"{"feedback_in_doubt":true}"#));
        follower.take(&report(""));
        assert_eq!(held(&mut follower), [GripState::Unknown; 6]);
        follower.take(&report(r#"{"feedback_in_doubt":false}"#));
        assert_eq!(held(&mut follower), [GripState::Holding; 6]);
        let at = Moment::from_micros(9_000_000);
        let state = LinkState::Offline;
        let gone = follower.take(&Entry::Heard(Record::State { at, state }));
        assert_eq!(gone, Some(Grip::unknown(at)));
    }
}
