//! What the link is doing and why, as plain values that may cross to any thread. No task, no wire.

use crate::hand::{Dof, Force, Moment, PerDof, Speed};
use crate::link::quirks::Quirks;
use crate::transport::TransportError;

/// Where one conversation with one hand stands (`design.md` §4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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

/// Everything the window shows of the link.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinkStatus {
    /// Where it stands.
    pub state: LinkState,
    /// Since when.
    pub since: Moment,
    /// What is being tried while there is no wire.
    pub dialling: Dialling,
    /// Why the wire was lost or could not be opened; kept until the hand answers again.
    pub trouble: Option<LinkTrouble>,
    /// The arming in force, if the hand is armed.
    pub armed: Option<ArmEpoch>,
    /// What the hand answers in its own way, as found when the wire was opened.
    pub quirks: Quirks,
    /// True if the adapter gives back what is sent.
    pub echoes: bool,
    /// Another controller talks to this hand, noticed in the last seconds.
    pub rival: bool,
    /// The port at which the adapter is now, if that is another than was asked for.
    pub moved_to: Option<String>,
    /// How long the adapter may keep what it got, milliseconds, where the system tells.
    pub latency_timer_ms: Option<u16>,
    /// Round trips stand at the ticks of such a timer, where the system does not tell.
    pub latency_ticks: bool,
    /// The line is left to a hand that saves or calibrates: values grow old meanwhile. A stop still passes.
    pub line_left: bool,
    /// How the last hold went.
    pub hold: Hold,
    /// Why the hand is not armed, if it was.
    pub disarmed: Option<Disarmed>,
}

/// What happens while there is no wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dialling {
    /// Nothing: no one asked for a hand, or there is a wire.
    #[default]
    Idle,
    /// The wire is being opened, for the n-th time in a row.
    Trying {
        /// 1 for the first.
        attempt: u32,
    },
    /// Waiting before the next try.
    Waiting {
        /// Tries so far.
        attempt: u32,
        /// When the next begins.
        until: Moment,
    },
}

/// Why there is no live hand.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LinkTrouble {
    /// The wire could not be opened, or broke.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The wire is open and the hand says nothing.
    #[error(
        "no answer from id {id}: check power, id, baud and protocol of the hand, or let 'handscope scan' try them all"
    )]
    NoAnswer {
        /// Id or unit that was asked.
        id: u16,
    },
    /// Something is heard on the wire, and none of it is an answer.
    #[error(
        "something answers on {place}, but not as id {id} at this speed and in this protocol: 'handscope scan' finds out what it is"
    )]
    Garbled {
        /// Port or interface.
        place: String,
        /// Id that was asked.
        id: u16,
    },
    /// A host takes the connection and says nothing.
    #[error(
        "{place} takes the connection, but nothing there answers as unit {unit}: check address, port and unit, and that no other program keeps the hand busy"
    )]
    Mute {
        /// Address and port.
        place: String,
        /// Unit that was asked.
        unit: u16,
    },
    /// The hand answered and then fell silent for several requests in a row.
    #[error("the hand stopped answering: {silent} requests without a reply")]
    Silent {
        /// Requests in a row.
        silent: u32,
    },
    /// Late replies could no longer be told from fresh ones, so the line was closed.
    #[error(
        "the line carried late replies: it was reopened so that no old value is taken for a new one"
    )]
    Ambiguous,
    /// This computer slept.
    #[error("this computer was asleep for {slept_s} s: what was shown before is old")]
    Suspended {
        /// Seconds.
        slept_s: u64,
    },
}

/// How a stop goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    Rival,
}

/// Why the hand cannot be armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
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
    /// The hand did not acknowledge its speed and force limits.
    #[error("the hand did not acknowledge its speed and force limits")]
    NoAnswer,
    /// A joint without a fresh, sensible angle.
    #[error("the angle of a joint is unknown or old")]
    UnknownPose {
        /// The first such joint.
        dof: Dof,
    },
}

/// What a person arms with: the first write that leaves the armed hand is this, never an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArmRequest {
    /// Speeds to set before anything moves.
    pub speed: PerDof<Speed>,
    /// Force thresholds to set before anything moves.
    pub force: PerDof<Force>,
}

/// One arming. Setpoints carry it, so that none from an earlier arming can act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct ArmEpoch(pub u64);
