//! States of a grip, each with its start and the age of the readings behind it.

use crate::hand::dof::PerFinger;
use crate::hand::moment::Moment;
use serde::Serialize;
use std::time::Duration;

/// State of a finger, or of the whole grasp, with respect to an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GripState {
    /// The readings are missing, old or contradictory.
    #[default]
    Unknown,
    /// At rest and open.
    Open,
    /// In motion, with or without contact.
    Moving,
    /// At rest and closed, with nothing in the way.
    Empty,
    /// At rest, pressing on something that does not move; of the grasp: with two fingers or more.
    Holding,
    /// Pressing on something that slides or is about to slide.
    Slipping,
    /// Lost the object without opening. Lasts until the finger opens or touches something.
    Lost,
    /// Pressing harder than the threshold allows.
    TooHard,
    /// Of the grasp only: one finger alone holds. It may press on anything, as a palm that supports an object is not read.
    Touching,
}

impl GripState {
    /// All states, in the order of [`Self::number`].
    pub const ALL: [Self; 9] = [
        Self::Unknown,
        Self::Open,
        Self::Moving,
        Self::Empty,
        Self::Holding,
        Self::Slipping,
        Self::Lost,
        Self::TooHard,
        Self::Touching,
    ];

    /// True for the states in which an object is pressed at rest.
    pub const fn is_held(self) -> bool {
        self.is_still() || matches!(self, Self::Slipping | Self::TooHard)
    }

    /// True while an object is pressed at rest and nothing else is to be said of it: what a step *until holding* waits for.
    pub const fn is_still(self) -> bool {
        matches!(self, Self::Holding | Self::Touching)
    }

    /// Stable number for numeric tables: 0 (unknown) to 8 (touching), in the order of [`Self::ALL`].
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// Stable lower-case name, as in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Open => "open",
            Self::Moving => "moving",
            Self::Empty => "empty",
            Self::Holding => "holding",
            Self::Slipping => "slipping",
            Self::Lost => "lost",
            Self::TooHard => "too_hard",
            Self::Touching => "touching",
        }
    }
}

/// A state, its start and the age of its evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GripEstimate {
    /// Current state.
    pub state: GripState,
    /// Time at which the state was entered.
    pub since: Moment,
    /// Request time of the oldest reading behind the state; `None` without any reading.
    pub asked: Option<Moment>,
}

impl GripEstimate {
    /// Age of the oldest reading behind the state.
    pub fn age(&self, now: Moment) -> Option<Duration> {
        self.asked.map(|asked| now.since(asked))
    }

    /// Sets the state; its start is unchanged if the state is the same.
    pub(crate) fn become_state(&mut self, state: GripState, at: Moment, asked: Option<Moment>) {
        if self.state != state {
            self.since = at;
        }
        self.state = state;
        self.asked = asked;
    }

    fn at(mut self, now: Moment, fresh_for: Duration) -> Self {
        if self.age(now).is_none_or(|age| age > fresh_for) {
            self.become_state(GripState::Unknown, now, self.asked);
        }
        self
    }
}

/// Grip of a hand according to the newest reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Grip {
    /// One estimate per finger; the thumb's covers both its joints.
    pub fingers: PerFinger<GripEstimate>,
    /// Estimate for all fingers together.
    pub grasp: GripEstimate,
    /// Age up to which a reading counts.
    pub fresh_for: Duration,
}

impl Grip {
    /// Unknown grip since `since`.
    pub fn unknown(since: Moment) -> Self {
        let estimate = GripEstimate {
            since,
            ..GripEstimate::default()
        };
        Self {
            fingers: PerFinger::splat(estimate),
            grasp: estimate,
            fresh_for: Duration::ZERO,
        }
    }

    /// Returns the grip at time `now`; a state whose readings are too old becomes unknown.
    #[must_use]
    pub fn at(&self, now: Moment) -> Self {
        Self {
            fingers: self.fingers.map(|finger| finger.at(now, self.fresh_for)),
            grasp: self.grasp.at(now, self.fresh_for),
            fresh_for: self.fresh_for,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_called_as_json_has_it() {
        for state in GripState::ALL {
            assert_eq!(serde_json::to_value(state).unwrap(), state.name());
            assert_eq!(GripState::ALL[usize::from(state.number())], state);
        }
    }

    #[test]
    fn a_grip_that_is_not_read_again_grows_unknown() {
        let asked = Moment::from_micros(1_000_000);
        let held = GripEstimate {
            state: GripState::Holding,
            since: asked,
            asked: Some(asked),
        };
        let grip = Grip {
            fingers: PerFinger::splat(held),
            grasp: held,
            fresh_for: Duration::from_millis(500),
        };
        let later = |ms| asked.plus(Duration::from_millis(ms));
        assert_eq!(grip.at(later(500)), grip);
        let old = grip.at(later(501));
        assert_eq!(old.grasp.state, GripState::Unknown);
        assert_eq!(old.grasp.since, later(501));
        assert_eq!(old.grasp.age(later(501)), Some(Duration::from_millis(501)));
    }
}
