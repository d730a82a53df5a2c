//! Scripts: autonomous behaviour of the simulated hand. Only computes; the hand applies the result.

use crate::hand::{Dof, Fault, Finger, PerDof, Status};
use std::str::FromStr;

/// Autonomous behaviour of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scenario {
    /// No motion; a soft ball lies between the fingers.
    #[default]
    Idle,
    /// No motion; nothing lies between the fingers.
    Free,
    /// No motion; a block lies between the fingers, as hard as the one used for the overshoot table.
    Rigid,
    /// No motion; a cup lies between the fingers. It breaks if pressed too hard, and is replaced when the hand opens.
    Fragile,
    /// Simulates another controller that repeatedly grasps the ball.
    Grasp,
    /// No motion and nothing in reach; an external force presses the fingertips in turn.
    Touched,
    /// Every status code and every fault bit, in turn.
    Faults,
    /// Values outside the manual's ranges.
    Extremes,
    /// Feedback freezes once a joint has moved a little, while the joints continue.
    Frozen,
}

/// Error for an unknown scenario name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "'{got}' is not a scenario: choose idle, free, rigid, fragile, grasp, touched, faults, extremes or frozen"
)]
pub struct UnknownScenario {
    /// Name that was given.
    pub got: String,
}

impl Scenario {
    /// All scenarios, the quiet one first.
    pub const ALL: [Self; 9] = [
        Self::Idle,
        Self::Free,
        Self::Rigid,
        Self::Fragile,
        Self::Grasp,
        Self::Touched,
        Self::Faults,
        Self::Extremes,
        Self::Frozen,
    ];

    /// Stable lower-case name, as in endpoints.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Free => "free",
            Self::Rigid => "rigid",
            Self::Fragile => "fragile",
            Self::Grasp => "grasp",
            Self::Touched => "touched",
            Self::Faults => "faults",
            Self::Extremes => "extremes",
            Self::Frozen => "frozen",
        }
    }
}

impl FromStr for Scenario {
    type Err = UnknownScenario;

    fn from_str(text: &str) -> Result<Self, UnknownScenario> {
        Self::ALL
            .into_iter()
            .find(|scenario| scenario.name() == text)
            .ok_or_else(|| UnknownScenario { got: text.into() })
    }
}

/// Setpoints of the hand's own action.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActionSetpoints {
    /// ANGLE_SET.
    pub angles: PerDof<i16>,
    /// FORCE_SET, g.
    pub forces: PerDof<i16>,
    /// SPEED_SET.
    pub speeds: PerDof<i16>,
}

/// Length of one grasp, ms.
const GRASP_MS: u64 = 8000;
/// Force thresholds of the grasp, different for each finger to distinguish them.
const GRASP_FORCES: PerDof<i16> = PerDof::new([330, 470, 600, 560, 640, 500]);
/// Order of the grasp's action that begins in this millisecond.
pub fn grasp_order(now_ms: u64) -> Option<ActionSetpoints> {
    let (angles, more, speed) = match now_ms % GRASP_MS {
        // Because of the dead time, motion starts at 0.4 s.
        336 => ([120, 120, 120, 120, 200, 320], 0, 400),
        // The hand tightens slowly, as in response to the slip.
        2760 => ([100, 100, 100, 100, 180, 320], 260, 5),
        5000 => ([1000; 6], 0, 400),
        _ => return None,
    };
    Some(ActionSetpoints {
        angles: PerDof::new(angles),
        forces: GRASP_FORCES.map(|force| force + more),
        speeds: PerDof::splat(speed),
    })
}

/// Length of each fingertip's turn in `touched`, and the pressed part of it, ms.
const TOUCH_TURN_MS: u64 = 2000;
const TOUCH_MS: u64 = 1200;
/// Pressing force, g.
const TOUCH_G: f64 = 300.0;

/// Pressing force on this fingertip at this time, g; in the first turn no fingertip is pressed.
pub fn touched_g(scenario: Scenario, finger: Finger, now_ms: u64) -> f64 {
    let fingers = u64::try_from(Finger::ALL.len()).unwrap_or(1);
    let turn = now_ms / TOUCH_TURN_MS;
    let is_its = turn > 0 && u64::try_from(finger.index()).is_ok_and(|at| at == turn % fingers);
    match scenario {
        Scenario::Touched if is_its && now_ms % TOUCH_TURN_MS < TOUCH_MS => TOUCH_G,
        _ => 0.0,
    }
}

/// Duration of each phase of `faults`, ms.
pub const FAULT_PHASE_MS: u64 = 1500;

/// Condition that one drive of the `faults` script shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ailment {
    /// A status without a fault.
    Says(Status),
    /// A fault; over-temperature includes the heat.
    Has(Fault),
}

/// Phases of `faults`, in order.
const FAULT_PHASES: [&[(Dof, Ailment)]; 8] = [
    &[],
    &[
        (Dof::Little, Ailment::Says(Status::Releasing)),
        (Dof::Ring, Ailment::Says(Status::Grasping)),
        (Dof::Middle, Ailment::Says(Status::PositionReached)),
        (Dof::Index, Ailment::Says(Status::ForceReached)),
        (Dof::ThumbBend, Ailment::Says(Status::CurrentProtection)),
        (Dof::ThumbRotate, Ailment::Says(Status::Stalled)),
    ],
    &[(Dof::Index, Ailment::Has(Fault::Stall))],
    &[(Dof::Middle, Ailment::Has(Fault::OverTemperature))],
    &[(Dof::ThumbBend, Ailment::Has(Fault::OverCurrent))],
    &[(Dof::Ring, Ailment::Has(Fault::Motor))],
    &[(Dof::ThumbRotate, Ailment::Has(Fault::Communication))],
    &[
        (Dof::Little, Ailment::Has(Fault::Stall)),
        (Dof::Little, Ailment::Has(Fault::OverTemperature)),
        (Dof::Middle, Ailment::Has(Fault::OverCurrent)),
        (Dof::Index, Ailment::Has(Fault::Motor)),
        (Dof::Index, Ailment::Has(Fault::Communication)),
        (Dof::ThumbBend, Ailment::Has(Fault::Stall)),
    ],
];

/// Returns the phase that begins in this millisecond.
pub fn fault_phase(now_ms: u64) -> Option<&'static [(Dof, Ailment)]> {
    if !now_ms.is_multiple_of(FAULT_PHASE_MS) {
        return None;
    }
    let phases = u64::try_from(FAULT_PHASES.len()).unwrap_or(1);
    let index = usize::try_from(now_ms / FAULT_PHASE_MS % phases).unwrap_or_default();
    FAULT_PHASES.get(index).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_and_a_wrong_one_names_the_right_ones() {
        for scenario in Scenario::ALL {
            assert_eq!(scenario.name().parse::<Scenario>(), Ok(scenario));
        }
        let in_endpoints = crate::transport::endpoint::SCENARIOS;
        assert_eq!(Scenario::ALL.map(Scenario::name), in_endpoints);
        let error = "grip".parse::<Scenario>().unwrap_err().to_string();
        for scenario in Scenario::ALL {
            assert!(error.contains(scenario.name()));
        }
    }

    #[test]
    fn the_fault_pictures_hold_every_status_and_every_bit() {
        let shown: Vec<Ailment> = FAULT_PHASES
            .iter()
            .flat_map(|phase| phase.iter().map(|(_, ailment)| *ailment))
            .collect();
        for bit in 0..5 {
            assert!(shown.contains(&Ailment::Has(Fault::from_bit(bit))));
        }
        for code in [0, 1, 2, 3, 5, 6] {
            assert!(shown.contains(&Ailment::Says(Status::from_raw(code))));
        }
    }
}
