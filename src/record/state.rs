//! State of a link, progress of a stop, and reasons why a hand is not armed.

use crate::hand::{Dof, Moment};
use serde::{Deserialize, Serialize};
use std::fmt;

/// State of one conversation with one hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinkState {
    /// No wire.
    #[default]
    Offline,
    /// A wire, but no answer yet.
    Identifying,
    /// The hand answers; nothing is written.
    Monitoring,
    /// The user armed it: setpoints pass.
    Armed,
    /// Stop was pressed: hold is repeated until the hand rests.
    Holding,
    /// A drive reports a fault: only reads, hold and clearing pass.
    Fault,
}

impl LinkState {
    /// True if the hand answers.
    pub const fn is_live(self) -> bool {
        matches!(
            self,
            Self::Monitoring | Self::Armed | Self::Holding | Self::Fault
        )
    }
}

/// Motion state of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rest {
    /// Fresh feedback shows no motion, and no motion was commanded just now.
    Resting,
    /// A joint moves, or moved within the last second.
    Moving,
    /// Feedback is missing, outdated, or inconclusive. Nothing that requires rest may be done.
    #[default]
    Unknown,
}

/// Progress of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// No stop since the hand answered.
    #[default]
    None,
    /// Hold is being repeated.
    Asked {
        /// Time at which stop was pressed.
        at: Moment,
        /// Hold frames sent so far.
        sent: u32,
    },
    /// Feedback shows that the hand rests.
    Confirmed {
        /// Time at which stop was pressed.
        at: Moment,
        /// Time at which feedback showed rest.
        rest: Moment,
    },
    /// Feedback does not show rest in time: the hand may still move. Hold continues.
    Alarm {
        /// Time at which stop was pressed.
        at: Moment,
    },
}

/// Reason why a hand is no longer armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Disarmed {
    Stop,
    /// The user disarmed it.
    Person,
    /// A drive reports a fault.
    Fault,
    LinkLost,
    /// Feedback is outdated.
    Stale,
    /// Feedback is frozen while motion is commanded: the hand's position cannot be known.
    FrozenFeedback,
    /// This computer slept.
    Resume,
    /// Another controller communicates with this hand.
    OtherController,
    /// The controller released the control that must be held, or has nothing left to do.
    Released,
    /// The controller fell silent.
    Silent,
    /// A drive is too hot.
    Hot,
    /// The temperature of a drive is implausible, or was not read for too long.
    HeatUnknown,
}

impl Disarmed {
    /// True if the controller or the user intended it.
    pub const fn is_asked_for(self) -> bool {
        matches!(
            self,
            Self::Stop | Self::Person | Self::Released | Self::Silent
        )
    }
}

/// Text of the reason, to be followed by its effect on the hand.
impl fmt::Display for Disarmed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stop => "a stop was requested",
            Self::Person => "it was disarmed",
            Self::Fault => "a drive reports a fault",
            Self::LinkLost => "the link was lost",
            Self::Stale => "feedback became stale",
            Self::FrozenFeedback => "feedback is frozen while motion is commanded",
            Self::Resume => "this computer slept",
            Self::OtherController => "another controller talks to the hand",
            Self::Released => "the hold-to-run control was released",
            Self::Silent => "it received no command for too long",
            Self::Hot => "a drive is too hot",
            Self::HeatUnknown => "the temperature of a drive is implausible or unknown",
        })
    }
}

/// Reason why the hand cannot be armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArmRefusal {
    /// No live hand.
    #[error("there is no live hand")]
    Offline,
    /// A stop is still in progress.
    #[error("a stop is still being confirmed")]
    Holding,
    /// A drive reports a fault.
    #[error("a drive reports a fault: clear it first")]
    Fault,
    /// The hand saves or calibrates: it has the line to itself, so its joints are not monitored.
    #[error("the hand is writing its flash or calibrating: wait until it is done")]
    HandBusy,
    /// The control that must be held while the hand moves is not held.
    #[error("the hold-to-run control is not held")]
    LetGo,
    /// A stop, a disarm or another arming was requested before this one was complete.
    #[error("another request came before the hand was armed")]
    Replaced,
    #[error("the hand did not acknowledge its speed and force limits")]
    NoAnswer,
    /// The hand, or the gateway in front of it, refused them.
    #[error(
        "the hand refused its speed and force limits; if another Handscope shares it, ask someone there to grant you control"
    )]
    Refused,
    /// The program that shares the hand does not let this one have control now.
    #[error(
        "the program that shares the hand keeps control of it: another one has control, or nobody there has granted it; ask there"
    )]
    Taken,
    /// Angles or faults were not read yet, or are outdated.
    #[error("angles and faults are unknown or stale")]
    NotRead,
    /// A joint with an implausible angle.
    #[error("implausible angle of {}", dof.name())]
    UnknownPose {
        /// The first such joint.
        dof: Dof,
    },
}

/// A group of setpoints of six joints, as the hand holds it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SetpointRegister {
    AngleSet,
    ForceSet,
    SpeedSet,
}

impl SetpointRegister {
    /// The manual's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::AngleSet => "ANGLE_SET",
            Self::ForceSet => "FORCE_SET",
            Self::SpeedSet => "SPEED_SET",
        }
    }

    /// Maximum rounding of a value by the hand: two hundredths of the range.
    pub const fn rounds_by(self) -> i16 {
        match self {
            Self::AngleSet | Self::SpeedSet => 20,
            Self::ForceSet => 60,
        }
    }
}

/// A setpoint of the hand that differs from the written one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetpointConflict {
    /// Register that was read.
    pub register: SetpointRegister,
    /// The first joint with such a value.
    pub dof: Dof,
    /// The value that was read; `None` if it is outside the manual's range.
    pub holds: Option<i16>,
    /// The value that was last written here; `None` if there is none.
    pub wrote: Option<i16>,
}

impl fmt::Display for SetpointConflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (register, dof) = (self.register.name(), self.dof.name());
        match self.holds {
            None => write!(f, "{register}: {dof} out of range")?,
            Some(holds) => write!(f, "{register}: {dof} {holds}")?,
        }
        match self.wrote {
            Some(wrote) => write!(f, ", we wrote {wrote}"),
            None => Ok(()),
        }
    }
}
