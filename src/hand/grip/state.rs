//! The states of a grip, each with its beginning and the age of what it rests on.

use crate::hand::dof::PerFinger;
use crate::hand::moment::Moment;
use serde::Serialize;
use std::time::Duration;

/// What a finger, or the whole grasp, does to an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GripState {
    /// What it would rest on is missing, old, or contradicts itself.
    #[default]
    Unknown,
    /// At rest, open.
    Open,
    /// On its way, with or without contact.
    Moving,
    /// At rest, closed, and nothing in the way.
    Empty,
    /// At rest, and pressing on something that stays where it is.
    Holding,
    /// Pressing on something that slides, or is about to.
    Slipping,
    /// It held something, which is gone though the finger did not open. Until the finger opens or touches something.
    Lost,
    /// Pressing harder than the threshold allows.
    TooHard,
}

impl GripState {
    /// All.
    pub const ALL: [Self; 8] = [
        Self::Unknown,
        Self::Open,
        Self::Moving,
        Self::Empty,
        Self::Holding,
        Self::Slipping,
        Self::Lost,
        Self::TooHard,
    ];

    /// Stable number, as tables of numbers have it: 0 unknown to 7 too hard, in the order of [`Self::ALL`].
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// Stable lower-case name, as JSON has it.
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
        }
    }
}

/// A state with its beginning and what it rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GripEstimate {
    /// The state.
    pub state: GripState,
    /// When it was first told.
    pub since: Moment,
    /// When the oldest of the readings that it rests on was asked for; `None` while it rests on nothing.
    pub asked: Option<Moment>,
}

impl GripEstimate {
    /// Age of the oldest reading that it rests on.
    pub fn age(&self, now: Moment) -> Option<Duration> {
        self.asked.map(|asked| now.since(asked))
    }

    /// Takes a newer state; its beginning stays if it is the same.
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

/// The grip of a hand as the newest reading shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Grip {
    /// Of each finger; the thumb's is of both its joints.
    pub fingers: PerFinger<GripEstimate>,
    /// Of all together.
    pub grasp: GripEstimate,
    /// How long a reading counts.
    pub fresh_for: Duration,
}

impl Grip {
    /// Nothing is known, since then.
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

    /// The grip as it is known at `now`: what rests on old readings is unknown.
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
