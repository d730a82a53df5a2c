//! Poses that need no library.

use crate::hand::{Angle, Dof};

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
    #[must_use]
    pub fn angle(self, dof: Dof) -> Option<Angle> {
        match (self, dof) {
            (Self::Open, _) => Some(Angle::MAX),
            (Self::Half | Self::Close, Dof::ThumbRotate) => None,
            (Self::Half, _) => Some(Angle::nearest(500)),
            (Self::Close, _) => Some(Angle::MIN),
        }
    }
}
