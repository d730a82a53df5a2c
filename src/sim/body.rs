//! Six drives around an object, and the force sensors' errors. Knows no registers.

use crate::hand::{Dof, Finger, PerDof};
use crate::sim::body_params::BodyParams;
use crate::sim::drive::{Drive, DriveSettings};
use crate::sim::object::Object;

/// Interval at which the sensors' noise is redrawn, ms.
const NOISE_MS: u64 = 10;

/// The whole mechanism.
#[derive(Debug, Clone)]
pub struct Body {
    drives: PerDof<Drive>,
    rest_g: PerDof<f64>,
    noise_g: PerDof<f64>,
    params: BodyParams,
}

impl Body {
    /// Creates an open hand around `object`, at an ambient temperature between 25 and 30 °C.
    pub fn new(object: &Object, params: &BodyParams, rng: &mut fastrand::Rng) -> Self {
        // Scatter has its own random numbers, so that a body without scatter behaves as before.
        let mut seeds = rng.clone();
        let drive = |dof| {
            let ambient = 25.0 + 5.0 * rng.f64();
            Drive::of(params.joints[dof], ambient, seeds.u64(..))
        };
        let mut body = Self {
            drives: PerDof::from_fn(drive),
            rest_g: PerDof::from_fn(|dof| {
                -8.0 + 12.0 * rng.f64() + params.joints[dof].force_zero_g
            }),
            noise_g: PerDof::splat(0.0),
            params: *params,
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

    /// Takes the object out of the hand, or puts it back.
    pub fn set_present(&mut self, present: bool) {
        for (_, drive) in self.drives.iter_mut() {
            if present {
                drive.return_object();
            } else {
                drive.remove_object();
            }
        }
    }

    /// Sets the share of the contact force that is present, 1 = all.
    pub fn set_grip(&mut self, grip: f64) {
        for (_, drive) in self.drives.iter_mut() {
            drive.set_grip(grip);
        }
    }

    /// True if every joint has room for a new object.
    pub fn has_room(&self) -> bool {
        self.drives.iter().all(|(_, drive)| drive.has_room())
    }

    /// True if a joint broke its side of the object.
    pub fn is_broken(&self) -> bool {
        self.drives.iter().any(|(_, drive)| drive.is_broken())
    }

    /// All drives.
    pub const fn drives(&self) -> &PerDof<Drive> {
        &self.drives
    }

    /// One drive, for commands.
    pub fn drive_mut(&mut self, dof: Dof) -> &mut Drive {
        &mut self.drives[dof]
    }

    /// Advances all drives by one millisecond.
    pub fn step(&mut self, now_ms: u64, settings: &PerDof<DriveSettings>, rng: &mut fastrand::Rng) {
        let slower = self.slower();
        for (dof, drive) in self.drives.iter_mut() {
            let mut setting = settings[dof];
            setting.speed *= slower;
            drive.step(now_ms, setting);
        }
        if now_ms.is_multiple_of(NOISE_MS) {
            self.noise_g = PerDof::from_fn(|dof| {
                (2.0 * rng.f64() - 1.0) * self.params.joints[dof].force_noise_g
            });
        }
    }

    /// Share of full speed that the joints reach with a weak supply.
    fn slower(&self) -> f64 {
        let moving = self.drives.iter().filter(|(_, drive)| drive.is_moving());
        let others: f64 = moving.skip(1).map(|_| 1.0).sum();
        1.0 - self.params.supply.sag * others / 5.0
    }

    /// Reading of the force sensor, g.
    pub fn force_g(&self, dof: Dof) -> f64 {
        self.drives[dof].load_g() + self.offset_g(dof)
    }

    /// Reading of the force sensor without any load, g.
    pub fn offset_g(&self, dof: Dof) -> f64 {
        self.rest_g[dof] + self.noise_g[dof]
    }

    /// True force on a fingertip, g.
    pub fn fingertip_g(&self, finger: Finger) -> f64 {
        self.drives[finger.bend()].load_g()
    }

    /// Zeroes the force sensors at their present reading (manual 2.6.6); with an object in the hand the zero is wrong from then on.
    pub fn calibrate_force(&mut self) {
        for dof in Dof::ALL {
            self.rest_g[dof] -= self.drives[dof].load_g() + self.rest_g[dof];
        }
    }
}
