//! Objects between the fingers. Moves nothing.

use crate::hand::PerDof;
use crate::hand::impact::RIGID_G_PER_COUNT;
use crate::sim::scenario::Scenario;

/// Object in the way of one joint as it bends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// Angle at which the fingertip touches, 0..=1000.
    pub angle: f64,
    /// Stiffness of the object, g for each position count. A hand's body multiplies it.
    pub stiffness: f64,
    /// Force that breaks the object, g; it is replaced by a new one when the joint is open again. `None` = unbreakable.
    pub breaks_at_g: Option<f64>,
}

/// An object between the fingers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// Contact of each joint; `None` = the joint misses the object.
    pub contacts: PerDof<Option<Obstacle>>,
}

/// Angle at which the block and the cup are touched, units of ANGLE_ACT.
const STANDS_AT: f64 = 500.0;
/// Stiffness of the cup: half of the block's.
const CUP_G_PER_COUNT: f64 = RIGID_G_PER_COUNT / 2.0;
/// Force of each finger above which the cup breaks, g.
pub const CUP_BREAKS_AT_G: f64 = 700.0;

impl Object {
    /// Object between the fingers at power-up.
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

    /// A soft ball, which each finger touches at a different angle; the thumb's rotation misses it.
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
                angle.map(|angle| Obstacle {
                    angle,
                    stiffness: 4.0,
                    breaks_at_g: None,
                })
            }),
        }
    }

    /// A block as hard as the one used for the overshoot table, at one angle for all joints.
    pub const fn rigid(angle: f64) -> Self {
        Self {
            contacts: PerDof::splat(Some(Obstacle {
                angle,
                stiffness: RIGID_G_PER_COUNT,
                breaks_at_g: None,
            })),
        }
    }

    /// A thin cup at one angle for all joints; each joint breaks its own side of it beyond [`CUP_BREAKS_AT_G`].
    pub const fn cup(angle: f64) -> Self {
        Self {
            contacts: PerDof::splat(Some(Obstacle {
                angle,
                stiffness: CUP_G_PER_COUNT,
                breaks_at_g: Some(CUP_BREAKS_AT_G),
            })),
        }
    }
}
