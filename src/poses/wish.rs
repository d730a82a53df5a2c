//! What the user asks for besides single joints: poses that every hand knows, and entries of the library that are played.

use crate::hand::{Angle, Dof};
use crate::poses::library::{EntryId, SequenceId};

/// Poses that need no library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Preset {
    /// Every joint open.
    Open,
    /// Fingers and thumb half bent; the thumb's rotation stays.
    Half,
    /// Fingers and thumb bent; the thumb's rotation stays.
    Close,
}

impl Preset {
    /// Where this joint goes, if it moves at all.
    pub fn angle(self, dof: Dof) -> Option<Angle> {
        match (self, dof) {
            (Self::Open, _) => Some(Angle::MAX),
            (Self::Half | Self::Close, Dof::ThumbRotate) => None,
            (Self::Half, _) => Some(Angle::nearest(500)),
            (Self::Close, _) => Some(Angle::MIN),
        }
    }
}

/// What the user does with a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::VariantNames, strum::IntoStaticStr)]
pub enum Play {
    /// Run a sequence or a reaction from its start. Needs arming.
    Start(EntryId),
    /// Take one step, then wait. Needs arming.
    Step(SequenceId),
    /// Hold where the hand is, until resumed.
    Pause,
    /// Go on where it was paused.
    Resume,
    /// End it and hold where the hand is.
    End,
}
