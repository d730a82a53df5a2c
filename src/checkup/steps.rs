//! What a check-up does, in order. One joint moves while the others are open, so that thumb and fingers never meet.

use crate::hand::{Angle, Dof, PerDof, Speed};
use std::collections::VecDeque;

/// The two speeds at which each joint is moved.
pub(crate) const SPEEDS: [i16; 2] = [200, 500];
/// Where all six go to at once: far from where thumb and fingers meet.
const TOGETHER: i16 = 700;

/// Which way a joint goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    Closing,
    Opening,
}

/// One part of a check-up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// All joints open, from wherever they are.
    Open,
    /// Nothing moves.
    Rest,
    /// One joint goes through its whole stroke.
    Stroke(Dof, Speed, Way),
    /// All six move a part of theirs at once.
    Together(Way),
}

impl Step {
    /// Where the joints go that move in it.
    pub(crate) fn targets(self) -> PerDof<Option<Angle>> {
        let end = |way| match way {
            Way::Closing => Angle::MIN,
            Way::Opening => Angle::MAX,
        };
        match self {
            Self::Rest => PerDof::splat(None),
            Self::Open | Self::Together(Way::Opening) => PerDof::splat(Some(Angle::MAX)),
            Self::Together(Way::Closing) => PerDof::splat(Some(Angle::nearest(TOGETHER))),
            Self::Stroke(moved, _, way) => PerDof::from_fn(|dof| (dof == moved).then(|| end(way))),
        }
    }

    /// How fast they go.
    pub(crate) fn speed(self) -> Speed {
        match self {
            Self::Stroke(_, speed, _) => speed,
            Self::Open | Self::Rest | Self::Together(_) => slow(),
        }
    }
}

/// The slower speed.
pub(crate) fn slow() -> Speed {
    let [slow, _] = SPEEDS;
    Speed::nearest(slow)
}

/// All steps.
pub(crate) fn steps() -> VecDeque<Step> {
    let ways = [Way::Closing, Way::Opening];
    let strokes = Dof::ALL.into_iter().flat_map(|dof| {
        let speeds = SPEEDS.map(Speed::nearest).into_iter();
        speeds.flat_map(move |speed| ways.map(|way| Step::Stroke(dof, speed, way)))
    });
    let together = ways.map(Step::Together);
    [Step::Open, Step::Rest]
        .into_iter()
        .chain(strokes)
        .chain(together)
        .chain([Step::Rest])
        .collect()
}
