//! What the link is doing and why, as plain values that may cross to any thread. No task, no wire.

use crate::hand::{ArmEpoch, DriveHeat, Force, ModbusException, Moment, PerDof, Setpoints, Speed};
use crate::link::lease::LeaseHolder;
use crate::link::quirks::Quirks;
use crate::link::series::Series;
use crate::record::{Disarmed, Hold, LinkState, Rest, SetpointConflict};
use crate::transport::TransportError;
use std::time::Duration;

/// Angles older than this are neither armed with, nor held to, nor gone by, on a way that is not slow.
pub(crate) const ANGLE_FRESH: Duration = Duration::from_millis(250);

/// Everything the window shows of the link.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct LinkStatus {
    /// Connection, arming and stop as one state.
    pub state: LinkState,
    /// When `state` began.
    pub since: Moment,
    /// What is being tried while there is no wire.
    pub dialling: Dialling,
    /// Why the wire was lost or could not be opened; kept until the hand answers again.
    pub trouble: Option<LinkTrouble>,
    /// The arming in force, if the hand is armed.
    pub armed: Option<ArmEpoch>,
    /// It was armed, and was not seen to rest since, also over a link that was lost.
    pub may_move: bool,
    /// Who may move the hand, if anybody may.
    pub holder: Option<LeaseHolder>,
    /// What the hand answers in its own way, as found when the wire was opened.
    pub quirks: Quirks,
    /// Whether it is a hand of this series; only such a hand is written to.
    pub series: Series,
    /// True if the adapter gives back what is sent.
    pub echoes: bool,
    /// Another controller talks to this hand, noticed in the last seconds.
    pub other_controller: bool,
    /// What another controller was last seen to write since the hand was armed; `None` if it was only heard.
    pub foreign_setpoint: Option<SetpointConflict>,
    /// A setpoint that the hand holds otherwise than it was given since it was armed, though nobody else was seen to write: it
    /// ignores or limits it.
    pub setpoint_not_taken: Option<SetpointConflict>,
    /// Motion was asked for, and nothing that the hand tells changed: frames are valid, and where the joints are is only reckoned. Until
    /// something changes.
    pub feedback_in_doubt: bool,
    /// The port at which the adapter is now, if that is another than was asked for.
    pub moved_to: Option<String>,
    /// How long the adapter may keep what it got, milliseconds, where the system tells.
    pub latency_timer_ms: Option<u16>,
    /// Round trips stand at the ticks of such a timer, where the system does not tell.
    pub latency_ticks: bool,
    /// How long replies take, milliseconds, where that is longer than a hand takes: the way to it is slow.
    pub slow_ms: Option<u16>,
    /// The line is left to a hand that saves or calibrates: values grow old meanwhile. A stop still passes.
    pub line_left: bool,
    /// The drive with the highest temperature, if that is warm or implausible.
    pub heat: Option<DriveHeat>,
    /// Whether the hand rests, by feedback and what was written.
    pub rest: Rest,
    /// How the last hold went.
    pub hold: Hold,
    /// The last stall of this program: meanwhile nothing was read, which says nothing of the hand.
    pub stall: Option<Stall>,
    /// Why the hand is not armed, if it was.
    pub disarmed: Option<Disarmed>,
    /// Why no process could be started that stops the hand if this program is killed, if so.
    pub unguarded: Option<String>,
}

impl LinkStatus {
    /// Whether the hand may go on to where it was sent, or be sent somewhere, and nothing stops it yet.
    pub fn goes_on(&self) -> bool {
        let is_left = self.may_move && self.state != LinkState::Holding;
        self.holder.is_some() || is_left
    }

    /// How much later than from a quick hand a reading may come: a slow way brings one three delays after the one before was asked for.
    pub fn slow_allowance(&self) -> Duration {
        Duration::from_millis(self.slow_ms.unwrap_or(0).into()) * 3
    }

    /// How old a reading may be by which it is judged where a motion stands.
    pub fn fresh_for(&self) -> Duration {
        ANGLE_FRESH + self.slow_allowance()
    }

    /// Whether it may go on though its right to be moved is over, and nothing showed rest: it owes a stop, unless another controller
    /// moves it.
    pub fn owes_stop(&self) -> bool {
        let is_left = self.may_move && self.holder.is_none();
        is_left && self.disarmed != Some(Disarmed::OtherController)
    }

    /// True if what the hand tells counts: it answers, and what it tells follows what it was told.
    pub fn is_believed(&self) -> bool {
        self.state.is_live() && !self.feedback_in_doubt
    }
}

/// A time in which this program could not attend to the wire: the computer was busy with something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Stall {
    /// When it was over.
    pub ended: Moment,
    /// How long it lasted.
    pub lasted: Duration,
}

/// What happens while there is no wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize)]
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
    /// Exceptions come in place of answers: a gateway is there, and the hand behind it is not.
    #[error(
        "{place} answers, but the hand behind it does not: {exception} (Modbus exception {code:02X}); check the hand's power and its cable to the gateway",
        code = exception.code()
    )]
    Gateway {
        /// Address or port of the gateway.
        place: String,
        /// What it said last.
        exception: ModbusException,
    },
    /// What answers is no hand of this series: the manual's addresses hold other things there.
    #[error(
        "{place} answers like a hand, but not of this series: its registers hold other things, so nothing is shown and nothing is written"
    )]
    OtherSeries {
        /// Address, port or interface.
        place: String,
    },
    /// Nothing but what was sent came back.
    #[error(
        "{place} only gives back what is sent: the adapter echoes, and no hand answers behind it; check the hand's power and cable"
    )]
    OnlyEcho {
        /// Port or address.
        place: String,
    },
    /// The hand answered and then fell silent for several requests in a row.
    #[error("the hand stopped answering: {silent} requests without a reply")]
    Silent {
        /// Requests in a row without a reply.
        silent: u32,
    },
    /// The hand fell silent for several requests in a row, while this program could not attend to the wire.
    #[error(
        "the hand stopped answering: {silent} requests without a reply, while this computer was too busy for {stalled_ms} ms to attend to it"
    )]
    Stalled {
        /// Requests in a row without a reply.
        silent: u32,
        /// Milliseconds of stalls in that time.
        stalled_ms: u32,
    },
    /// Late replies could no longer be told from fresh ones, so the line was closed.
    #[error(
        "the line carried late replies: it was reopened so that no old value is taken for a new one"
    )]
    Ambiguous,
    /// This computer slept.
    #[error("this computer was asleep for {slept_s} s: what was shown before is old")]
    Suspended {
        /// Seconds of sleep by the system's clock.
        slept_s: u64,
    },
}

/// What the user arms with: the first write that leaves the armed hand is this, never an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArmRequest {
    /// Speeds to set before anything moves.
    pub speed: PerDof<Speed>,
    /// Force thresholds to set before anything moves.
    pub force: PerDof<Force>,
}

impl ArmRequest {
    /// What a hand is armed with where nothing is named.
    pub const GENTLE: Self = Self {
        speed: PerDof::splat(Speed::GENTLE),
        force: PerDof::splat(Force::GENTLE),
    };

    /// The same for a hand that is armed already.
    pub fn setpoints(&self, epoch: ArmEpoch) -> Setpoints {
        Setpoints {
            speed: self.speed.map(Some),
            force: self.force.map(Some),
            ..Setpoints::none(epoch)
        }
    }
}
