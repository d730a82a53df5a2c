//! What goes on at a hand, and so who may move it now. The only place where that is decided.

use crate::link::{LinkStatus, Owner};

/// What goes on at a hand. Of several things it is the first of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Activity {
    /// It was told to hold, and is left as soon as it rests.
    Leaving,
    /// A card is open: its place is changed, its parameters are reset, or its force sensors are calibrated.
    Procedure,
    /// A series of trials or a check-up runs.
    Series,
    /// It follows another than this window, which the user let.
    Following(Owner),
    /// An entry of the library is played. The user takes the hand from it by moving it.
    Playing,
    Idle,
}

impl Activity {
    /// Whether the user at this window may move an armed hand: joints, poses, sequences, gestures.
    pub const fn lets_person_move(self) -> bool {
        matches!(self, Self::Playing | Self::Idle)
    }

    /// Whether the user may arm the hand. One that follows is taken back by that.
    pub const fn lets_arm(self) -> bool {
        matches!(
            self,
            Self::Series | Self::Following(_) | Self::Playing | Self::Idle
        )
    }

    /// Whether the user may let another than this window move it.
    pub const fn lets_grant(self) -> bool {
        matches!(self, Self::Following(_) | Self::Playing | Self::Idle)
    }

    /// Whether nothing has the hand to itself, so that what it keeps may be read beside.
    pub const fn lets_read_beside(self) -> bool {
        matches!(
            self,
            Self::Leaving | Self::Following(_) | Self::Playing | Self::Idle
        )
    }

    /// Whether an exhibition may begin.
    pub const fn lets_exhibit(self) -> bool {
        matches!(self, Self::Following(_) | Self::Playing | Self::Idle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_activity_lets_others_do_what_stands_here_and_nothing_else() {
        let follows = Activity::Following(Owner::Gamepad);
        // Person moves, arms, grants; what the hand keeps is read; an exhibition begins.
        for (activity, lets) in [
            (Activity::Leaving, [false, false, false, true, false]),
            (Activity::Procedure, [false, false, false, false, false]),
            (Activity::Series, [false, true, false, false, false]),
            (follows, [false, true, true, true, true]),
            (Activity::Playing, [true, true, true, true, true]),
            (Activity::Idle, [true, true, true, true, true]),
        ] {
            let own = [
                activity.lets_person_move(),
                activity.lets_arm(),
                activity.lets_grant(),
                activity.lets_read_beside(),
                activity.lets_exhibit(),
            ];
            assert_eq!(own, lets, "{activity:?}");
        }
    }
}

/// Who moves the hand, as the events of a recording tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct RecordedMover {
    /// The trial, and how many there are, in the arming of then.
    pub(crate) trial: Option<(usize, usize)>,
}

impl RecordedMover {
    /// A trial began, as its words say: `2 of 4`, and then the joints.
    pub(crate) fn begin_trial(&mut self, words: &str) {
        let numbers = words.split(", ").next();
        let numbers = numbers.and_then(|numbers| numbers.split_once(" of "));
        self.trial =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    }

    /// The link's status changed: no series goes on without arming.
    pub(crate) fn take_status(&mut self, link: &LinkStatus) {
        self.trial = self.trial.filter(|_| link.armed.is_some());
    }
}
