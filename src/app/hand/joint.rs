//! One joint as a person sets it, and the poses that every hand knows.

use crate::hand::{Angle, Dof, Force, Speed};

/// One joint as a person sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JointControl {
    /// Where the slider stands: the actual angle while not armed, the person's wish while armed. `None` = not known.
    pub target: Option<Angle>,
    /// Force threshold; sent at arming and when changed while armed.
    pub force: Force,
    /// Speed; sent at arming and when changed while armed.
    pub speed: Speed,
    /// Leave this joint alone.
    pub locked: bool,
}

impl Default for JointControl {
    fn default() -> Self {
        Self {
            target: None,
            force: Force::GENTLE,
            speed: Speed::GENTLE,
            locked: false,
        }
    }
}

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
