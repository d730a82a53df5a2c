//! Why a program that moved the hand was aborted.

use crate::hand::{Dof, Fault, Faults};
use crate::record::state::{Disarmed, SetpointConflict};
use std::time::Duration;

/// Why a program that moved the hand was aborted. The hand was stopped, unless another controller moves it now. Only the user who
/// arms starts another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Abort {
    /// The user ended it.
    #[error("ended by a person")]
    Person,
    /// Stop, disarming, old feedback.
    #[error("the hand is no longer armed{}", why.map(|why| format!(": {why}")).unwrap_or_default())]
    Disarmed {
        /// As the link has it.
        why: Option<Disarmed>,
    },
    /// Another arming is not the one that the user gave for this.
    #[error("the hand was armed anew")]
    ArmedAnew,
    /// Another mover of this program, or another program, was granted control. It moves the hand now: this is the only abort that no
    /// stop follows.
    #[error("another controller has control of the hand")]
    TakenOver,
    /// Another controller talks to the hand.
    #[error("another controller {}", wrote.map_or_else(|| "talks to the hand".into(), |wrote| format!("wrote {wrote}")))]
    OtherController {
        /// What it was seen to write; `None` if it was only heard.
        wrote: Option<SetpointConflict>,
    },
    /// The link was lost. Where the hand is now is not known.
    #[error("the link was lost")]
    LinkLost,
    /// A drive reports a fault.
    #[error("{}", fault_words(*joint))]
    Fault {
        /// The first such joint, with all its faults; `None` if none of them was read yet.
        joint: Option<(Dof, Faults)>,
    },
    /// A joint is as warm as the limit.
    #[error("{} is at {celsius} °C, the limit is {limit}", dof.name())]
    Heat {
        /// The joint.
        dof: Dof,
        /// Its temperature.
        celsius: u8,
        limit: u8,
    },
    /// The force of a joint reached the ceiling.
    #[error("{} presses with {grams} g, the ceiling is {ceiling}", dof.name())]
    Ceiling {
        /// The joint.
        dof: Dof,
        /// Force above its reading at rest.
        grams: i32,
        ceiling: i16,
    },
    /// A joint did not reach its target in time.
    #[error("{} did not reach {target} in time", dof.name())]
    Unreached {
        /// The joint.
        dof: Dof,
        /// Where it should be.
        target: i16,
    },
    /// The speed and threshold that were set are not confirmed by reading back.
    #[error("the hand does not confirm the speed and force threshold that were set for {}", dof.name())]
    LimitsRefused {
        /// The joint.
        dof: Dof,
    },
    /// Readings of all joints that the limits depend on are missing or old.
    #[error("the {what} readings cannot be watched: {}", not_read(*age, *stall))]
    NotRead {
        what: &'static str,
        /// How old the last is; `None` if none came.
        age: Option<Duration>,
        /// How long this program did not run meanwhile, if that is why.
        stall: Option<Duration>,
    },
    /// A reading that the limits depend on makes no sense.
    #[error("the {what} of {} cannot be watched: it makes no sense", dof.name())]
    Blind {
        what: &'static str,
        /// The joint.
        dof: Dof,
    },
    /// The hand stayed too warm to begin.
    #[error("{} stayed at {celsius} °C or more; trials begin below {limit}", dof.name())]
    TooWarm {
        /// The joint.
        dof: Dof,
        /// Its temperature.
        celsius: u8,
        /// Where it may begin.
        limit: u8,
    },
    /// The samples could not be stored or shown.
    #[error("the samples could not be stored or shown")]
    NotKept,
    /// A joint of a hand that should be empty pressed on something.
    #[error("the hand is not empty, or something is in its way: {} pressed with {grams} g at {angle}", dof.name())]
    NotEmpty {
        /// The joint.
        dof: Dof,
        /// Where, units of ANGLE_ACT.
        angle: i16,
        /// Force above its reading at rest.
        grams: i16,
    },
    /// The slow trial that should measure the contact found none.
    #[error("{} found no contact to approach", dof.name())]
    NoContact {
        /// The joint.
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

/// Why readings are old, in words.
fn not_read(age: Option<Duration>, stall: Option<Duration>) -> String {
    match (age, stall) {
        (None, _) => "none came yet".into(),
        (Some(age), None) => format!(
            "the last is {:.1} s old, and the hand sends no newer one in time",
            age.as_secs_f64()
        ),
        (Some(age), Some(stall)) => format!(
            "the last is {:.1} s old, because this computer was busy: the program did not run for {:.1} s",
            age.as_secs_f64(),
            stall.as_secs_f64()
        ),
    }
}
