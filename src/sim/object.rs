//! What stands between the fingers. Moves nothing.

use crate::hand::PerDof;
use crate::hand::impact::RIGID_G_PER_COUNT;
use crate::sim::scenario::Scenario;

/// What a joint meets while it bends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Angle at which the fingertip touches, 0..=1000.
    pub angle: f64,
    /// Stiffness of the object, g for each position count. A hand's body multiplies it.
    pub stiffness: f64,
    /// Force that it does not survive, g; a whole one is put there when the joint is open again.
    pub breaks_at_g: Option<f64>,
}

/// An object between the fingers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// What each joint meets; `None` = it misses the object.
    pub contacts: PerDof<Option<Contact>>,
}

/// Where the block and the cup stand in the way, units of ANGLE_ACT.
const STANDS_AT: f64 = 500.0;
/// Stiffness of the cup: half of the block's.
const CUP_G_PER_COUNT: f64 = RIGID_G_PER_COUNT / 2.0;
/// What each finger may press the cup with, g.
pub const CUP_BREAKS_AT_G: f64 = 700.0;

impl Object {
    /// What waits between the fingers at power-up.
    pub fn of(scenario: Scenario) -> Self {
        match scenario {
            Scenario::Free | Scenario::Touched | Scenario::Frozen => Self::none(),
            Scenario::Rigid => Self::rigid(STANDS_AT),
            Scenario::Fragile => Self::cup(STANDS_AT),
            Scenario::Idle | Scenario::Grasp | Scenario::Faults | Scenario::Extremes => {
                Self::soft_ball()
            }
        }
    }

    /// Nothing between the fingers.
    pub const fn none() -> Self {
        Self {
            contacts: PerDof::splat(None),
        }
    }

    /// A soft ball that every finger meets a little later than its neighbour; the thumb's rotation misses it.
    pub fn soft_ball() -> Self {
        let angles = PerDof::new([
            Some(355.0),
            Some(390.0),
            Some(430.0),
            Some(410.0),
            Some(450.0),
            None,
        ]);
        Self {
            contacts: angles.map(|angle| {
                angle.map(|angle| Contact {
                    angle,
                    stiffness: 4.0,
                    breaks_at_g: None,
                })
            }),
        }
    }

    /// A block as hard as the one the overshoot was measured on, at one angle for all joints.
    pub const fn rigid(angle: f64) -> Self {
        Self {
            contacts: PerDof::splat(Some(Contact {
                angle,
                stiffness: RIGID_G_PER_COUNT,
                breaks_at_g: None,
            })),
        }
    }

    /// A thin cup at one angle for all joints; each breaks its own side of it beyond [`CUP_BREAKS_AT_G`].
    pub const fn cup(angle: f64) -> Self {
        Self {
            contacts: PerDof::splat(Some(Contact {
                angle,
                stiffness: CUP_G_PER_COUNT,
                breaks_at_g: Some(CUP_BREAKS_AT_G),
            })),
        }
    }
}
