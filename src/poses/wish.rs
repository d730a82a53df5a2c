//! Motion requests other than single joints: built-in poses, and playing entries of the library.

use crate::hand::{Angle, Dof};
use crate::poses::library::{EntryId, SequenceId};

/// Built-in poses, independent of the library.
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
    /// The target of this joint; `None` if it stays where it is.
    pub fn angle(self, dof: Dof) -> Option<Angle> {
        match (self, dof) {
            (Self::Open, _) => Some(Angle::MAX),
            (Self::Half | Self::Close, Dof::ThumbRotate) => None,
            (Self::Half, _) => Some(Angle::nearest(500)),
            (Self::Close, _) => Some(Angle::MIN),
        }
    }
}

/// A command to the player.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::VariantNames, strum::IntoStaticStr)]
pub enum Play {
    /// Runs a sequence or a reaction from its start. Needs arming.
    Start(EntryId),
    /// Runs one step, then waits. Needs arming.
    Step(SequenceId),
    /// Holds the hand where it is until resumed.
    Pause,
    /// Continues after a pause.
    Resume,
    /// Ends playing and holds the hand where it is.
    End,
}
