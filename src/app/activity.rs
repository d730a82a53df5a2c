//! Activity of a hand, which decides who may move it. The only place for that decision.

use crate::link::{LinkStatus, Owner};
use crate::poses::library::EntryId;

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

/// A pose, a sequence, a demo or a hold, as recordings name it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RecordedPlay {
    pub(crate) kind: PlayKind,
    /// Name in the library; empty for a hold.
    pub(crate) name: String,
}

/// Kind of what is played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PlayKind {
    Pose,
    Sequence,
    Reaction,
    Hold,
}

impl PlayKind {
    const ALL: [Self; 4] = [Self::Pose, Self::Sequence, Self::Reaction, Self::Hold];

    /// Stable name in recordings.
    const fn key(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Sequence => "sequence",
            Self::Reaction => "demo",
            Self::Hold => "hold",
        }
    }
}

impl RecordedPlay {
    /// An entry of the library with its name.
    pub(crate) fn of(entry: EntryId, name: &str) -> Self {
        let kind = match entry {
            EntryId::Pose(_) => PlayKind::Pose,
            EntryId::Sequence(_) => PlayKind::Sequence,
            EntryId::Reaction(_) => PlayKind::Reaction,
        };
        let name = name.to_owned();
        Self { kind, name }
    }

    /// A hold.
    pub(crate) const fn hold() -> Self {
        Self {
            kind: PlayKind::Hold,
            name: String::new(),
        }
    }

    /// Text of its event: `sequence Wave`.
    pub(crate) fn words(&self) -> String {
        let words = format!("{} {}", self.kind.key(), self.name);
        words.trim_end().to_owned()
    }

    /// Reads the text of an event; `None` if it names something else.
    pub(crate) fn read(words: &str) -> Option<Self> {
        let (key, name) = words.split_once(' ').unwrap_or((words, ""));
        let kind = PlayKind::ALL.into_iter().find(|kind| kind.key() == key)?;
        let name = name.to_owned();
        Some(Self { kind, name })
    }
}

/// Party that moves the hand of a recording, according to its events.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct RecordedMover {
    /// Number of the current trial and of all trials, under the current arming.
    pub(crate) trial: Option<(usize, usize)>,
    /// What plays.
    play: Option<RecordedPlay>,
}

impl RecordedMover {
    /// Starts a trial according to its text: `2 of 4`, then the joints.
    pub(crate) fn begin_trial(&mut self, words: &str) {
        let numbers = words.split(", ").next();
        let numbers = numbers.and_then(|numbers| numbers.split_once(" of "));
        self.trial =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    }

    /// Begins to play what the text of an event names.
    pub(crate) fn begin_play(&mut self, words: &str) {
        self.play = RecordedPlay::read(words);
    }

    /// Nothing plays from now on.
    pub(crate) fn end_play(&mut self) {
        self.play = None;
    }

    /// What plays now; `None` if nothing does, or the recording does not name it.
    pub(crate) const fn playing(&self) -> Option<&RecordedPlay> {
        self.play.as_ref()
    }

    /// Applies a status of the link: nothing continues without arming.
    pub(crate) fn apply_status(&mut self, link: &LinkStatus) {
        self.trial = self.trial.filter(|_| link.armed.is_some());
        self.play.take_if(|_| link.armed.is_none());
    }
}
