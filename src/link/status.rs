//! State of the link and its reasons, as plain values for any thread. No task, no wire.

use crate::hand::{ArmEpoch, DriveHeat, Force, ModbusException, Moment, PerDof, Setpoints, Speed};
use crate::link::lease::LeaseHolder;
use crate::link::quirks::Quirks;
use crate::link::series::DeviceSeries;
use crate::record::{Disarmed, Hold, LinkState, Rest, SetpointConflict};
use crate::transport::TransportError;
use std::time::Duration;

/// Maximum age of angles for arming, holding and control, on a link that is not slow.
pub(crate) const ANGLE_FRESH: Duration = Duration::from_millis(250);

/// Everything that the window shows of the link.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct LinkStatus {
    /// Connection, arming and stop as one state.
    pub state: LinkState,
    /// Time at which `state` began.
    pub since: Moment,
    /// Connection attempts while there is no wire.
    pub dialling: Dialling,
    /// Reason why the wire was lost or could not be opened; kept until the hand answers again.
    pub trouble: Option<LinkTrouble>,
    /// The current arming; `None` if the hand is not armed.
    pub armed: Option<ArmEpoch>,
    /// The hand was armed and was not seen at rest since, even if the link was lost.
    pub may_move: bool,
    /// The current lease and its owner; `None` without a lease.
    pub holder: Option<LeaseHolder>,
    /// Quirks of the hand, detected when the wire was opened.
    pub quirks: Quirks,
    /// Detected series; only a hand of this series is written to.
    pub series: DeviceSeries,
    /// True if the adapter echoes what is sent.
    pub echoes: bool,
    /// Another controller was detected in the last seconds.
    pub other_controller: bool,
    /// The last setpoint that another controller wrote since the hand was armed; `None` if only its requests were heard.
    pub foreign_setpoint: Option<SetpointConflict>,
    /// A setpoint that differs from the one sent since the hand was armed, without any sign of another writer: the hand
    /// ignores or limits it.
    pub setpoint_not_taken: Option<SetpointConflict>,
    /// Motion was commanded but feedback did not change: frames are valid, but the joint positions are only estimated.
    /// Until something changes.
    pub feedback_in_doubt: bool,
    /// The port of the adapter now, if it is not the requested one.
    pub moved_to: Option<String>,
    /// Latency timer of the adapter, in milliseconds; `None` if the system does not report it.
    pub latency_timer_ms: Option<u16>,
    /// Round trips match the ticks of such a timer; only set if the system does not report it.
    pub latency_ticks: bool,
    /// Reply time in milliseconds, if it is longer than the hand needs: the link is slow.
    pub slow_ms: Option<u16>,
    /// The line is reserved for a hand that saves or calibrates: values become old meanwhile. A stop is still sent.
    pub line_left: bool,
    /// The drive with the highest temperature, if it is warm or implausible.
    pub heat: Option<DriveHeat>,
    /// Rest state, from feedback and what was written.
    pub rest: Rest,
    /// State of the last hold.
    pub hold: Hold,
    /// The last stall of this program: nothing was read meanwhile, which says nothing about the hand.
    pub stall: Option<Stall>,
    /// Reason of the last disarm; `None` while the hand is armed or if it never was.
    pub disarmed: Option<Disarmed>,
    /// Reason why the holder process, which stops the hand if this program is killed, could not be started, if so.
    pub unguarded: Option<String>,
}

impl LinkStatus {
    /// True if the hand may continue to its target or be sent a new one, and no stop is in progress.
    pub fn may_continue(&self) -> bool {
        let is_left = self.may_move && self.state != LinkState::Holding;
        self.holder.is_some() || is_left
    }

    /// Additional age allowed for readings on a slow link: a reading may arrive three delays after the previous one was
    /// requested.
    pub fn slow_allowance(&self) -> Duration {
        Duration::from_millis(self.slow_ms.unwrap_or(0).into()) * 3
    }

    /// Maximum age of a reading that determines the progress of a motion.
    pub fn fresh_for(&self) -> Duration {
        ANGLE_FRESH + self.slow_allowance()
    }

    /// True if the hand may continue though its lease ended, and rest was not confirmed: it still needs a stop, unless
    /// another controller moves it.
    pub fn owes_stop(&self) -> bool {
        let is_left = self.may_move && self.holder.is_none();
        is_left && self.disarmed != Some(Disarmed::OtherController)
    }

    /// True if feedback is valid: the hand answers, and its feedback follows its commands.
    pub fn is_believed(&self) -> bool {
        self.state.is_live() && !self.feedback_in_doubt
    }
}

/// A time in which this program did not service the wire because the computer was busy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Stall {
    /// End of the stall.
    pub ended: Moment,
    /// Length of the stall.
    pub lasted: Duration,
}

/// State of the connection attempts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Dialling {
    /// No hand was requested, or there is a wire.
    #[default]
    Idle,
    /// The wire is being opened, for the n-th consecutive time.
    Trying {
        /// 1 for the first.
        attempt: u32,
    },
    /// Waiting before the next attempt.
    Waiting {
        /// Attempts so far.
        attempt: u32,
        /// Time of the next attempt.
        until: Moment,
    },
}

/// Reason why there is no live hand.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize)]
pub enum LinkTrouble {
    /// The wire could not be opened, or broke.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The wire is open, but nothing is received.
    #[error(
        "no answer from id {id}: check power, id, baud and protocol of the hand, or let 'handscope scan' try them all"
    )]
    NoAnswer {
        /// Id or unit of the requests.
        id: u16,
    },
    /// Data is received, but none of it is a valid reply.
    #[error(
        "something answers on {place}, but not as id {id} at this speed and in this protocol: 'handscope scan' finds out what it is"
    )]
    Garbled {
        /// Port or interface.
        place: String,
        /// Id of the requests.
        id: u16,
    },
    /// A host accepts the connection but sends nothing.
    #[error(
        "{place} takes the connection, but nothing there answers as unit {unit}: check address, port and unit, and that no other program keeps the hand busy"
    )]
    Mute {
        /// Address and port.
        place: String,
        /// Unit of the requests.
        unit: u16,
    },
    /// Exceptions instead of replies: a gateway is present, but the hand behind it is not.
    #[error(
        "{place} answers, but the hand behind it does not: {exception} (Modbus exception {code:02X}); check the hand's power and its cable to the gateway",
        code = exception.code()
    )]
    Gateway {
        /// Address or port of the gateway.
        place: String,
        /// The last exception.
        exception: ModbusException,
    },
    /// The device is not a hand of this series: the manual's addresses have other contents there.
    #[error(
        "{place} answers like a hand, but not of this series: its registers hold other things, so nothing is shown and nothing is written"
    )]
    OtherSeries {
        /// Address, port or interface.
        place: String,
    },
    /// Nothing but our own requests came back.
    #[error(
        "{place} only returns what is sent: the adapter echoes, and no hand answers behind it; check the hand's power and cable"
    )]
    OnlyEcho {
        /// Port or address.
        place: String,
    },
    /// The hand answered and then missed several consecutive requests.
    #[error("the hand stopped answering: {silent} requests without a reply")]
    Silent {
        /// Consecutive requests without a reply.
        silent: u32,
    },
    /// The hand missed several consecutive requests while this program did not service the wire.
    #[error(
        "the hand stopped answering: {silent} requests without a reply, while this computer was too busy for {stalled_ms} ms to attend to it"
    )]
    Stalled {
        /// Consecutive requests without a reply.
        silent: u32,
        /// Milliseconds of stalls in that time.
        stalled_ms: u32,
    },
    /// Late replies could not be distinguished from fresh ones, so the line was closed.
    #[error(
        "the line carried late replies: it was reopened so that no old value is taken for a new one"
    )]
    Ambiguous,
    /// The computer slept.
    #[error("this computer was asleep for {slept_s} s: what was shown before is old")]
    Suspended {
        /// Seconds of sleep by the system's clock.
        slept_s: u64,
    },
}

/// Limits of an arming: they are the first write to an armed hand, never an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArmRequest {
    /// Speeds to set before anything moves.
    pub speed: PerDof<Speed>,
    /// Force thresholds to set before anything moves.
    pub force: PerDof<Force>,
}

impl ArmRequest {
    /// Default limits of an arming.
    pub const GENTLE: Self = Self {
        speed: PerDof::splat(Speed::GENTLE),
        force: PerDof::splat(Force::GENTLE),
    };

    /// The same limits as setpoints, for a hand that is armed already.
    pub fn setpoints(&self, epoch: ArmEpoch) -> Setpoints {
        Setpoints {
            speed: self.speed.map(Some),
            force: self.force.map(Some),
            ..Setpoints::none(epoch)
        }
    }
}
