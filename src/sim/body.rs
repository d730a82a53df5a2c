//! Six drives, the object between the fingers, and the force sensors' errors. Knows no registers.

use crate::hand::impact::RIGID_G_PER_COUNT;
use crate::hand::{Dof, Finger, PerDof};
use crate::sim::drive::{Contact, Drive, Setting};
use crate::sim::scenario::Scenario;

/// How often the sensors' noise is drawn anew, ms.
const NOISE_MS: u64 = 10;
/// Force noise, g either way.
const FORCE_NOISE_G: f64 = 3.0;

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
    #[must_use]
    pub fn of(scenario: Scenario) -> Self {
        match scenario {
            Scenario::Rigid => Self::rigid(STANDS_AT),
            Scenario::Fragile => Self::cup(STANDS_AT),
            Scenario::Idle | Scenario::Grasp | Scenario::Faults | Scenario::Extremes => {
                Self::soft_ball()
            }
        }
    }

    /// Nothing between the fingers.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            contacts: PerDof::splat(None),
        }
    }

    /// A soft ball that every finger meets a little later than its neighbour; the thumb's rotation misses it.
    #[must_use]
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
    #[must_use]
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
    #[must_use]
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

/// The whole mechanism.
#[derive(Debug, Clone)]
pub struct Body {
    drives: PerDof<Drive>,
    rest_g: PerDof<f64>,
    noise_g: PerDof<f64>,
}

impl Body {
    /// An open hand around `object`, in a room between 25 and 30 °C.
    #[must_use]
    pub fn new(object: &Object, rng: &mut fastrand::Rng) -> Self {
        let mut body = Self {
            drives: PerDof::from_fn(|_| Drive::new(25.0 + 5.0 * rng.f64())),
            rest_g: PerDof::from_fn(|_| -8.0 + 12.0 * rng.f64()),
            noise_g: PerDof::splat(0.0),
        };
        body.set_object(object);
        body
    }

    /// Puts another object between the fingers.
    pub fn set_object(&mut self, object: &Object) {
        for (dof, drive) in self.drives.iter_mut() {
            drive.set_contact(object.contacts[dof]);
        }
    }

    /// One drive.
    #[must_use]
    pub const fn drives(&self) -> &PerDof<Drive> {
        &self.drives
    }

    /// One drive, to command it.
    pub fn drive_mut(&mut self, dof: Dof) -> &mut Drive {
        &mut self.drives[dof]
    }

    /// One millisecond for all drives.
    pub fn step(&mut self, now_ms: u64, settings: &PerDof<Setting>, rng: &mut fastrand::Rng) {
        for (dof, drive) in self.drives.iter_mut() {
            drive.step(now_ms, settings[dof]);
        }
        if now_ms.is_multiple_of(NOISE_MS) {
            self.noise_g = PerDof::from_fn(|_| (2.0 * rng.f64() - 1.0) * FORCE_NOISE_G);
        }
    }

    /// What the force sensor says, g.
    #[must_use]
    pub fn force_g(&self, dof: Dof) -> f64 {
        self.drives[dof].load_g() + self.rest_g[dof] + self.noise_g[dof]
    }

    /// Force on a fingertip, g, as it is.
    #[must_use]
    pub fn fingertip_g(&self, finger: Finger) -> f64 {
        self.drives[finger.bend()].load_g()
    }

    /// Takes what the sensors say now as zero (manual 2.6.6); with an object in the hand the zero is wrong from then on.
    pub fn calibrate_force(&mut self) {
        for dof in Dof::ALL {
            self.rest_g[dof] -= self.drives[dof].load_g() + self.rest_g[dof];
        }
    }
}
