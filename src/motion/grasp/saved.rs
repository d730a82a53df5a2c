//! A grasp as it is saved: a hold that worked, and its conditions. Pure.

use crate::hand::hold_forces::HoldForces;
use crate::hand::kinematics::{SegmentFrames, Side};
use crate::hand::statistics::mean;
use crate::hand::{Angle, Finger, Force, PerDof, PerFinger};
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::hold::HoldClose;
use crate::transport::Endpoint;

/// A hold that worked.
#[derive(Debug, Clone, PartialEq)]
pub struct Grasp {
    /// Its name, 1 to 32 characters.
    pub name: String,
    /// The user's text; may be empty.
    pub note: String,
    /// Date on which it was made, such as `2026-11-30`.
    pub made: String,
    /// The hand that it was made on.
    pub hand: Endpoint,
    /// How it closes.
    pub close: GraspClose,
    /// Its forces, in g of that hand where [`GraspFinger::reading_per_g`] is 1.
    pub forces: HoldForces,
    /// The fingers that held.
    pub fingers: PerFinger<Option<GraspFinger>>,
    /// The friction that it showed.
    pub friction: FrictionSeen,
    /// Largest load along the fingertips that was held, N; `None` if a fingertip that held was not read.
    pub load_n: Option<f64>,
    /// What Tune found out about that hand and object, if the user named it.
    pub claim: Option<GraspClaim>,
    /// How it went.
    pub result: GraspResult,
}

/// How a grasp closes.
#[derive(Debug, Clone, PartialEq)]
pub struct GraspClose {
    /// Name of the pose, for the reader; `None` for a pinch.
    pub pose: Option<String>,
    /// The close. Never [`HoldClose::TakeOver`].
    pub way: HoldClose,
}

/// A finger that held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GraspFinger {
    /// Angle at which it held.
    pub angle: Angle,
    /// Mean force with which it held, g of the hand.
    pub force_g: f64,
    /// Reading for one gram of the forces: 1, or what made them newtons.
    pub reading_per_g: f64,
    /// Newtons of a gram of the hand; `None` if they were not measured.
    pub newtons_per_g: Option<f64>,
    /// Stiffness of the contact, g of the hand for each unit of angle; `None` if it moved too little to show it.
    pub stiffness_g: Option<f64>,
}

/// Bounds of the friction: ratios of the load along all fingertips to the force on them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrictionSeen {
    /// Largest ratio at which the object did not slide: the friction is at least this.
    pub held_ratio: Option<f64>,
    /// Smallest ratio at which it slid on a finger; `None` if it never did.
    pub slid_ratio: Option<f64>,
}

/// A claim of Tune.
#[derive(Debug, Clone, PartialEq)]
pub struct GraspClaim {
    /// The claim in words.
    pub words: String,
    /// Bound of the peak force, g of the hand.
    pub peak_bound_g: f64,
    /// SPEED_SET and FORCE_SET to which it applies.
    pub speed: i64,
    /// As [`speed`](Self::speed).
    pub force_threshold_g: i64,
    /// Number of closes behind it.
    pub closes: i64,
}

/// How a hold went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GraspResult {
    /// Time for which it held, s.
    pub held_s: f64,
    /// Number of times that a finger pressed harder.
    pub tightened: u32,
}

impl GraspFinger {
    /// Mean force with which it held, N.
    pub fn force_n(&self) -> Option<f64> {
        Some(self.force_g * self.newtons_per_g?)
    }

    /// Newtons of one gram of the forces.
    fn newtons_of_force(&self) -> Option<f64> {
        Some(self.reading_per_g * self.newtons_per_g?)
    }

    /// Stiffness of the contact, N for each unit of angle.
    pub fn stiffness_n(&self) -> Option<f64> {
        Some(self.stiffness_g? * self.newtons_per_g?)
    }
}

impl Grasp {
    /// True if it was made on the hand at this endpoint, whatever object that holds.
    pub fn is_of(&self, hand: &Endpoint) -> bool {
        self.hand.place_and_id() == hand.place_and_id()
    }

    /// Reading of each joint for one gram of the forces on the hand that it was made on.
    pub fn reading_per_g(&self) -> PerDof<f64> {
        spread_over(&self.fingers.map(|own| own.map(|own| own.reading_per_g)))
    }

    /// The same on another hand with these newtons for a gram of its reading, so that the forces are equal in newtons.
    ///
    /// # Errors
    /// [`GraspDoubt`]: newtons are missing, or a force is impossible there.
    pub fn reading_per_g_on(
        &self,
        newtons: &PerDof<Option<f64>>,
    ) -> Result<PerDof<f64>, GraspDoubt> {
        let mut readings = PerFinger::splat(None);
        for finger in Finger::ALL {
            let Some(own) = self.fingers[finger] else {
                continue;
            };
            let there = own
                .newtons_of_force()
                .ok_or(GraspDoubt::NoNewtonsThere { finger })?;
            let here = newtons[finger.bend()].ok_or(GraspDoubt::NoNewtonsHere { finger })?;
            let per_g = there / here;
            check_room(self.forces, finger, per_g)?;
            readings[finger] = Some(per_g);
        }
        Ok(spread_over(&readings))
    }

    /// Stiffness of the contact of a finger, N/mm: that of its angle, over the way of the pad by the model of the hand. `None` without
    /// newtons or stiffness.
    pub fn stiffness_n_per_mm(&self, finger: Finger) -> Option<f64> {
        let per_angle = self.fingers[finger]?.stiffness_n()?;
        Some(per_angle / f64::from(self.pad_mm_per_angle(finger)?))
    }

    /// Way of a pad for one unit of its bending joint near the held angles, mm; joints that did not hold count as open.
    fn pad_mm_per_angle(&self, finger: Finger) -> Option<f32> {
        let held = self.fingers[finger]?;
        let pad = |angle: f32| {
            let mut shares = PerDof::splat(1.0);
            shares[finger.bend()] = angle / f32::from(Angle::MAX.get());
            SegmentFrames::of_shares(Side::Right, &shares).tip(finger)
        };
        let angle = f32::from(held.angle.get().clamp(1, Angle::MAX.get() - 1));
        let way = pad(angle - 1.0).distance(pad(angle + 1.0)) / 2.0;
        (way > 0.0).then_some(way)
    }
}

/// A number of four significant digits: measured values are not more precise, and files are read by people.
pub(super) fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Values of the joints that bend these fingers; those of the others are the mean.
fn spread_over(fingers: &PerFinger<Option<f64>>) -> PerDof<f64> {
    let known: Vec<f64> = fingers.as_array().iter().flatten().copied().collect();
    let others = mean(&known).unwrap_or(1.0);
    PerDof::from_fn(|dof| fingers[dof.finger()].unwrap_or(others))
}

/// Checks that a hold is possible between the forces, as the hand reads them at this finger.
fn check_room(forces: HoldForces, finger: Finger, per_g: f64) -> Result<(), GraspDoubt> {
    #[expect(clippy::cast_possible_truncation, reason = "the range is checked next")]
    let reading = |force: Force| (f64::from(force.get()) * per_g).round() as i64;
    let [least, most] = [forces.at_least(), forces.at_most()].map(reading);
    // More than a threshold can be is more than the rated grip, too.
    let [at_least, at_most] = [least, most].map(Force::nearest);
    let room = HoldForces::new(at_least, at_most).map(|_| ());
    room.map_err(|why| GraspDoubt::NoRoom { finger, why })
}
