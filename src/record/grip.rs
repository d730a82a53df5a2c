//! Derives the grip of the hand from entries, for a file, a viewer, DDS and a table alike.

use crate::hand::Moment;
use crate::hand::grip::{Grip, GripEstimator, GripState};
use crate::record::{Entry, LinkReport, Record};
use serde::Deserialize;

/// Follows the grip entry after entry.
#[derive(Debug, Clone, Default)]
pub(crate) struct GripFollower {
    estimator: GripEstimator,
    /// Time since which feedback does not follow the commands.
    doubted: Option<Moment>,
}

/// Relevant part of a link status.
#[derive(Deserialize)]
struct FeedbackDoubt {
    #[serde(default)]
    feedback_in_doubt: bool,
}

impl GripFollower {
    /// Applies an entry. Returns the grip after it, if it is a reading or ends the readings.
    pub(crate) fn apply(&mut self, entry: &Entry) -> Option<Grip> {
        match entry {
            Entry::Heard(Record::Reading { sample, fresh }) => {
                let at = entry.at();
                let grip = self.estimator.apply(sample, *fresh, at).at(at);
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

    /// The grip known at `at`, without a new reading.
    pub(crate) fn known(&self, at: Moment) -> Grip {
        let grip = self.estimator.known(true, at);
        self.doubted.map_or(grip, Grip::unknown)
    }

    /// Applies a status report; an unchanged status is empty and has no effect.
    fn report(&mut self, report: &LinkReport) {
        if let Ok(status) = serde_json::from_str::<FeedbackDoubt>(&report.status) {
            let is_new = self.doubted.is_none();
            self.doubted = match status.feedback_in_doubt {
                true if is_new => Some(report.at),
                true => self.doubted,
                false => None,
            };
        }
    }
}

/// Table cell of a state; `None` if it is unknown.
pub(crate) const fn cell(state: GripState) -> Option<&'static str> {
    match state {
        GripState::Unknown => None,
        known => Some(known.name()),
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
    use crate::hand::kinematics::Side;
    use crate::hand::{AngleReading, ForceReading, Group, HandSample, Status, Timed};
    use crate::record::LinkState;
    use crate::record::file::Opening;
    use crate::record::file::format::cdr;
    use crate::record::file::format::encode::EntryEncoder;
    use crate::record::file::format::message::GripMessage;
    use crate::record::file::format::topic::Topic;
    use std::sync::Arc;
    use std::time::Duration;

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
    fn a_grip_is_told_when_it_changes_and_once_a_second() {
        let opening = Opening::begin(
            "sim:".into(),
            (Moment::ZERO, Duration::from_secs(100)),
            Side::Right,
        );
        let mut encoder = EntryEncoder::new(&opening);
        let mut published: Vec<GripMessage> = Vec::new();
        for ms in (10..=2500).step_by(10) {
            let messages = encoder.encode(&reading(Moment::from_micros(ms * 1000)));
            let grips = messages.iter().filter(|own| own.topic == Topic::Grip);
            published.extend(grips.map(|own| cdr::decode::<GripMessage>(&own.bytes).unwrap()));
        }
        let states: Vec<&str> = published.iter().map(|own| own.state.as_str()).collect();
        let held = states.iter().position(|state| *state == "holding").unwrap();
        assert!(held <= 2, "{states:?}");
        assert_eq!(states[held..], ["holding"; 3], "and no more");
        let last = &published[published.len() - 1];
        assert_eq!(last.finger_states, ["holding"; 5]);
        assert_eq!(last.since, published[held].since);
        assert_eq!(last.asked, last.at, "it was asked for at once");
        let second = last.at.nanos() - published[published.len() - 2].at.nanos();
        assert_eq!(second, 1_000_000_000);
        // The next file knows of it at once.
        let mut next = encoder.next(&opening);
        let messages = next.encode(&reading(Moment::from_micros(2_510_000)));
        let first = messages
            .iter()
            .find(|own| own.topic == Topic::Grip)
            .unwrap();
        let first: GripMessage = cdr::decode(&first.bytes).unwrap();
        assert_eq!((first.state.as_str(), first.since), ("holding", last.since));
    }

    #[test]
    fn a_file_begins_with_the_grip_and_tells_it_where_readings_stop() {
        let opening = Opening::begin(
            "sim:".into(),
            (Moment::ZERO, Duration::from_secs(100)),
            Side::Right,
        );
        let state = |ms: u64| {
            let at = Moment::from_micros(ms * 1000);
            let state = LinkState::Monitoring;
            Entry::Heard(Record::State { at, state })
        };
        let grip_state = |encoder: &mut EntryEncoder, entry: &Entry| -> Option<String> {
            let messages = encoder.encode(entry);
            let grip = messages.iter().find(|own| own.topic == Topic::Grip)?;
            Some(cdr::decode::<GripMessage>(&grip.bytes).unwrap().state)
        };
        let mut encoder = EntryEncoder::new(&opening);
        let first = grip_state(&mut encoder, &state(5));
        assert_eq!(first.as_deref(), Some("unknown"), "before any reading");
        for ms in (10..=500).step_by(10) {
            encoder.encode(&reading(Moment::from_micros(ms * 1000)));
        }
        // A file that begins in the middle, with whatever comes first.
        let mut next = encoder.next(&opening);
        let held = grip_state(&mut next, &state(510));
        assert_eq!(held.as_deref(), Some("holding"));
        assert_eq!(grip_state(&mut next, &state(520)), None, "once");
        let old = grip_state(&mut next, &state(1200));
        assert_eq!(old.as_deref(), Some("unknown"), "its readings are old");
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
                states = super::states(&follower.apply(&entry).unwrap());
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
        follower.apply(&report(r#"{"feedback_in_doubt":true}"#));
        follower.apply(&report(""));
        assert_eq!(held(&mut follower), [GripState::Unknown; 6]);
        follower.apply(&report(r#"{"feedback_in_doubt":false}"#));
        assert_eq!(held(&mut follower), [GripState::Holding; 6]);
        let at = Moment::from_micros(9_000_000);
        let state = LinkState::Offline;
        let gone = follower.apply(&Entry::Heard(Record::State { at, state }));
        assert_eq!(gone, Some(Grip::unknown(at)));
    }
}
