//! Reason why a program that moved the hand was aborted.

use crate::hand::{Dof, Fault, Faults};
use crate::record::state::{Disarmed, SetpointConflict};
use std::time::Duration;

/// Reason why a program that moved the hand was aborted. The hand was stopped, unless another controller moves it now. Only the
/// user who arms starts another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Abort {
    /// The user ended it.
    #[error("ended by the user")]
    Person,
    /// Stop, disarming, outdated feedback.
    #[error("the hand is no longer armed{}", why.map(|why| format!(": {why}")).unwrap_or_default())]
    Disarmed {
        /// The link's reason.
        why: Option<Disarmed>,
    },
    /// The hand was armed again since the user armed it for this program.
    #[error("the hand was rearmed")]
    ArmedAnew,
    /// Another mover of this program, or another program, was granted control. It moves the hand now: this is the only abort that
    /// is not followed by a stop.
    #[error("another controller has control of the hand")]
    TakenOver,
    /// Another controller communicates with the hand.
    #[error("another controller {}", wrote.map_or_else(|| "talks to the hand".into(), |wrote| format!("wrote {wrote}")))]
    OtherController {
        /// The write that was observed; `None` if only other traffic was.
        wrote: Option<SetpointConflict>,
    },
    /// The link was lost. The hand's position is unknown.
    #[error("the link was lost")]
    LinkLost,
    /// A drive reports a fault.
    #[error("{}", fault_words(*joint))]
    Fault {
        /// The first such joint, with all its faults; `None` if none of them was read yet.
        joint: Option<(Dof, Faults)>,
    },
    /// A joint reached the temperature limit.
    #[error("{} is at {celsius} °C, the limit is {limit}", dof.name())]
    Heat {
        dof: Dof,
        /// Temperature in °C.
        celsius: u8,
        limit: u8,
    },
    /// The force of a joint reached the ceiling.
    #[error("{} presses with {grams} g, the ceiling is {ceiling}", dof.name())]
    Ceiling {
        dof: Dof,
        /// Force above its reading at rest, in grams.
        grams: i32,
        ceiling: i16,
    },
    /// A joint did not reach its target in time.
    #[error("{} did not reach {target} in time", dof.name())]
    Unreached {
        dof: Dof,
        /// Target position, units of ANGLE_ACT.
        target: i16,
    },
    /// The configured speed and force threshold are not confirmed by reading back.
    #[error("the hand does not confirm the speed and force threshold that were set for {}", dof.name())]
    LimitsRefused {
        /// The first joint that deviates.
        dof: Dof,
    },
    /// Readings that the limits depend on are missing or outdated.
    #[error("the {what} readings cannot be monitored: {}", not_read(*age, *stall))]
    NotRead {
        what: &'static str,
        /// Age of the last reading; `None` if none arrived.
        age: Option<Duration>,
        /// Time for which this program did not run meanwhile, if that is the cause.
        stall: Option<Duration>,
    },
    /// A reading that the limits depend on is implausible.
    #[error("the {what} of {} cannot be monitored: the value is implausible", dof.name())]
    Blind {
        what: &'static str,
        /// The joint with this reading.
        dof: Dof,
    },
    /// The hand stayed too warm to start.
    #[error("{} stayed at {celsius} °C or more; trials begin below {limit}", dof.name())]
    TooWarm {
        dof: Dof,
        /// Temperature in °C.
        celsius: u8,
        /// Temperature in °C below which it may start.
        limit: u8,
    },
    /// The samples could not be stored or shown.
    #[error("the samples could not be stored or shown")]
    NotKept,
    /// A joint of a hand that should be empty pressed against something.
    #[error("the hand is not empty, or something is in its way: {} pressed with {grams} g at {angle}", dof.name())]
    NotEmpty {
        dof: Dof,
        /// Position of the joint, units of ANGLE_ACT.
        angle: i16,
        /// Force above its reading at rest, in grams.
        grams: i16,
    },
    /// The slow trial that measures the contact found none.
    #[error("{} found no contact to approach", dof.name())]
    NoContact {
        /// The joint that closed.
        dof: Dof,
    },
}

fn fault_words(joint: Option<(Dof, Faults)>) -> String {
    let Some((dof, faults)) = joint else {
        return "a drive reports a fault".into();
    };
    let names: Vec<_> = faults.iter().map(Fault::name).collect();
    format!("{} reports a fault: {}", dof.name(), names.join(", "))
}

/// Text for missing or outdated readings.
fn not_read(age: Option<Duration>, stall: Option<Duration>) -> String {
    match (age, stall) {
        (None, _) => "none received yet".into(),
        (Some(age), None) => format!(
            "the last is {:.1} s old, and the hand sent no newer one in time",
            age.as_secs_f64()
        ),
        (Some(age), Some(stall)) => format!(
            "the last is {:.1} s old, because this computer was busy: the program did not run for {:.1} s",
            age.as_secs_f64(),
            stall.as_secs_f64()
        ),
    }
}
