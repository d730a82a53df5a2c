//! One joint as a person sets it, and a move of several.

use crate::hand::{Angle, Force, PerDof, Speed};

/// One joint as a person sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Joint {
    /// Where the slider stands: the actual angle while not armed, the person's wish while armed. `None` = not known.
    pub target: Option<Angle>,
    /// Force threshold; sent at arming and when changed while armed.
    pub force: Force,
    /// Speed; sent at arming and when changed while armed.
    pub speed: Speed,
    /// Leave this joint alone.
    pub locked: bool,
}

/// Where joints go and within which limits; what is `None` stays as it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Move {
    pub(crate) to: PerDof<Option<Angle>>,
    pub(crate) speed: PerDof<Option<Speed>>,
    pub(crate) force: PerDof<Option<Force>>,
}
