//! Where a link stands, how a stop went, and why a hand is not armed.

use crate::hand::{Dof, Moment};
use serde::{Deserialize, Serialize};

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
    /// A person armed it: setpoints pass.
    Armed,
    /// Stop was pressed: hold is repeated until the hand rests.
    Holding,
    /// A drive reports a fault: nothing passes but reads, hold and clearing.
    Fault,
}

impl LinkState {
    /// True if the hand answers.
    #[must_use]
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
    /// Stop.
    Stop,
    /// The person disarmed it.
    Person,
    /// A drive reports a fault.
    Fault,
    /// The link was lost.
    LinkLost,
    /// Feedback grew old.
    Stale,
    /// This computer slept.
    Resume,
    /// Another controller talks to this hand.
    OtherController,
    /// Who moved it let go of what has to be held, or has nothing to do.
    Released,
    /// Who moved it fell silent.
    Silent,
}

impl Disarmed {
    /// True if whoever might move the hand, or a person, wanted it so.
    #[must_use]
    pub const fn is_asked_for(self) -> bool {
        matches!(
            self,
            Self::Stop | Self::Person | Self::Released | Self::Silent
        )
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
    /// The hand did not acknowledge its speed and force limits.
    #[error("the hand did not acknowledge its speed and force limits")]
    NoAnswer,
    /// The hand, or the gateway that it is behind, refused them.
    #[error(
        "the hand refused its speed and force limits; if another Handscope shares it, a person there has to let you"
    )]
    Refused,
    /// A joint without a fresh, sensible angle.
    #[error("the angle of a joint is unknown or old")]
    UnknownPose {
        /// The first such joint.
        dof: Dof,
    },
}
