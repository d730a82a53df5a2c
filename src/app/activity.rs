//! Activity of a hand, which decides who may move it. The only place for that decision.

use crate::link::{LinkStatus, Owner};

/// Activity of a hand. If several apply, the first of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Activity {
    /// The hand was stopped, and its link closes as soon as it rests.
    Leaving,
    /// A card is open: a change of address, a reset or a calibration of the force sensors.
    Procedure,
    /// A series of trials or a check-up runs.
    Series,
    /// The hand follows another party, to which the user granted control.
    Following(Owner),
    /// An entry of the library is playing, or a hold runs. The user takes over by moving the hand.
    Playing,
    Idle,
}

impl Activity {
    /// True if the user at this window may move an armed hand: joints, poses, sequences, gestures.
    pub const fn lets_person_move(self) -> bool {
        matches!(self, Self::Playing | Self::Idle)
    }

    /// True if the user may arm the hand. Arming takes back a hand that follows.
    pub const fn lets_arm(self) -> bool {
        matches!(
            self,
            Self::Series | Self::Following(_) | Self::Playing | Self::Idle
        )
    }

    /// True if the user may grant control to another party.
    pub const fn lets_grant(self) -> bool {
        matches!(self, Self::Following(_) | Self::Playing | Self::Idle)
    }

    /// True if no activity needs the hand exclusively, so that its persistent parameters may be read meanwhile.
    pub const fn lets_read_beside(self) -> bool {
        matches!(
            self,
            Self::Leaving | Self::Following(_) | Self::Playing | Self::Idle
        )
    }

    /// True if an exhibition may begin.
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

/// Party that moves the hand of a recording, according to its events.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct RecordedMover {
    /// Number of the current trial and of all trials, under the current arming.
    pub(crate) trial: Option<(usize, usize)>,
}

impl RecordedMover {
    /// Starts a trial according to its text: `2 of 4`, then the joints.
    pub(crate) fn begin_trial(&mut self, words: &str) {
        let numbers = words.split(", ").next();
        let numbers = numbers.and_then(|numbers| numbers.split_once(" of "));
        self.trial =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    }

    /// Applies a status of the link: no series continues without arming.
    pub(crate) fn apply_status(&mut self, link: &LinkStatus) {
        self.trial = self.trial.filter(|_| link.armed.is_some());
    }
}
