//! Where a link stands, how a stop went, and why a hand is not armed.

use crate::hand::{Dof, Moment};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Where one conversation with one hand stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinkState {
    /// No wire.
    #[default]
    Offline,
    /// A wire, and no answer yet.
    Identifying,
    /// The hand answers; nothing is written.
    Monitoring,
    /// The user armed it: setpoints pass.
    Armed,
    /// Stop was pressed: hold is repeated until the hand rests.
    Holding,
    /// A drive reports a fault: nothing passes but reads, hold and clearing.
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

/// Whether the hand rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rest {
    /// Fresh feedback shows no motion, and none was commanded just now.
    Resting,
    /// A joint moves, or did within the last second.
    Moving,
    /// Feedback is missing, old, or does not say. Nothing that needs rest may be done.
    #[default]
    Unknown,
}

/// How a stop goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// None was asked since the hand answered.
    #[default]
    None,
    /// Hold is being repeated.
    Asked {
        /// When stop was pressed.
        at: Moment,
        /// Hold frames sent so far.
        sent: u32,
    },
    /// Feedback shows that the hand rests.
    Confirmed {
        /// When stop was pressed.
        at: Moment,
        /// When feedback showed rest.
        rest: Moment,
    },
    /// Feedback does not show rest in time: the hand may still move. Hold goes on.
    Alarm {
        /// When stop was pressed.
        at: Moment,
    },
}

/// Why a hand that was armed is not any more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Disarmed {
    Stop,
    /// The user disarmed it.
    Person,
    /// A drive reports a fault.
    Fault,
    LinkLost,
    /// Feedback grew old.
    Stale,
    /// Feedback stands still though motion was asked for: where the hand is cannot be known.
    FrozenFeedback,
    /// This computer slept.
    Resume,
    /// Another controller talks to this hand.
    OtherController,
    /// Who moved it let go of what has to be held, or has nothing to do.
    Released,
    /// Who moved it fell silent.
    Silent,
    /// A drive is too hot.
    Hot,
    /// The temperature of a drive is implausible, or was not read for too long.
    HeatUnknown,
}

impl Disarmed {
    /// True if whoever might move the hand, or the user, wanted it so.
    pub const fn is_asked_for(self) -> bool {
        matches!(
            self,
            Self::Stop | Self::Person | Self::Released | Self::Silent
        )
    }
}

/// In words, to be followed by what that did to the hand.
impl fmt::Display for Disarmed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stop => "it was told to stop",
            Self::Person => "it was disarmed",
            Self::Fault => "a drive reports a fault",
            Self::LinkLost => "the link was lost",
            Self::Stale => "feedback grew old",
            Self::FrozenFeedback => "feedback stands still though motion was asked for",
            Self::Resume => "this computer slept",
            Self::OtherController => "another controller talks to the hand",
            Self::Released => "it was let go",
            Self::Silent => "nothing was asked of it for too long",
            Self::Hot => "a drive is too hot",
            Self::HeatUnknown => "the temperature of a drive is implausible or unknown",
        })
    }
}

/// Why the hand cannot be armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArmRefusal {
    /// No live hand.
    #[error("there is no live hand")]
    Offline,
    /// Stop is still going on.
    #[error("a stop is still being confirmed")]
    Holding,
    /// A drive reports a fault.
    #[error("a drive reports a fault: clear it first")]
    Fault,
    /// The hand saves or calibrates: the line is left to it, so nobody looks where its joints are.
    #[error("the hand writes its flash or calibrates: wait until that is over")]
    HandBusy,
    /// What has to be held while the hand moves is not held.
    #[error("what has to be held to run is not held")]
    LetGo,
    /// A stop, a disarm or another arming was asked for before it was done.
    #[error("something else was asked for before the hand was armed")]
    Replaced,
    /// The hand did not acknowledge its speed and force limits.
    #[error("the hand did not acknowledge its speed and force limits")]
    NoAnswer,
    /// The hand, or the gateway that it is behind, refused them.
    #[error(
        "the hand refused its speed and force limits; if another Handscope shares it, a person there has to let you"
    )]
    Refused,
    /// Angles or faults were not read yet, or are old.
    #[error("angles and faults are not known yet, or are old")]
    NotRead,
    /// A joint without a sensible angle.
    #[error("the angle of {} makes no sense", dof.name())]
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

    /// What a hand may round a value by: two hundredths of the range.
    pub const fn rounds_by(self) -> i16 {
        match self {
            Self::AngleSet | Self::SpeedSet => 20,
            Self::ForceSet => 60,
        }
    }
}

/// A setpoint that the hand holds, other than we wrote it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetpointConflict {
    /// Where it was read.
    pub register: SetpointRegister,
    /// The first joint with such a value.
    pub dof: Dof,
    /// The value as it was read; `None` if it leaves the manual's range.
    pub holds: Option<i16>,
    /// What was written here last; `None` if nothing was.
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
