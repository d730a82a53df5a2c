//! The outcomes of writing a setting, of a SAVE, of a factory reset and of a calibration. Plain values; nothing is sent here.

use crate::hand::command::WRITE_LEN_MAX;
use crate::hand::register::ANGLE_SET;
use crate::hand::{Angle, PerDof, Refusal, RegisterWrite, Span};
use arrayvec::ArrayVec;
use std::time::Duration;

/// Memory as it was written. It is historical: no register write can be made from it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenMemory {
    /// Address of the first byte.
    pub address: u16,
    /// Bytes in memory order.
    pub bytes: ArrayVec<u8, WRITE_LEN_MAX>,
}

impl WrittenMemory {
    /// Written address range.
    pub fn span(&self) -> Span {
        Span::new(
            self.address,
            u16::try_from(self.bytes.len()).unwrap_or_default(),
        )
    }
}

impl WrittenMemory {
    /// Angle targets in this write; `None` for joints without a new target, or if the write concerns other registers.
    pub fn angle_targets(&self) -> PerDof<Option<Angle>> {
        let mut targets = PerDof::splat(None);
        let len = ANGLE_SET.element_len();
        for (place, (_, target)) in (0..).zip(targets.iter_mut()) {
            let at = Span::new(ANGLE_SET.address + len * place, len);
            let raw = self.span().slice(&self.bytes, at);
            let raw = raw.and_then(<[u8]>::first_chunk);
            *target = raw.and_then(|raw| Angle::new(i16::from_le_bytes(*raw)).ok());
        }
        targets
    }
}

impl From<&RegisterWrite> for WrittenMemory {
    fn from(write: &RegisterWrite) -> Self {
        Self {
            address: write.address(),
            bytes: write.bytes().iter().copied().collect(),
        }
    }
}

/// Cause of a write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WriteCause {
    /// A stop, or its repetition.
    Hold,
    /// The speed and force limits with which arming begins.
    Arming,
    /// A setpoint of the controller in charge.
    Setpoint,
    /// A single request: a gesture, clearing errors.
    Request,
    /// A setting, SAVE, reset or calibration.
    Setting,
}

impl WriteCause {
    pub const ALL: [Self; 5] = [
        Self::Hold,
        Self::Arming,
        Self::Setpoint,
        Self::Request,
        Self::Setting,
    ];

    /// Stable name in files.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Hold => "hold",
            Self::Arming => "arming",
            Self::Setpoint => "setpoint",
            Self::Request => "request",
            Self::Setting => "setting",
        }
    }
}

/// Outcome of a write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WriteFate {
    /// The hand acknowledged it. That does not mean that the value is in effect.
    Acknowledged,
    /// The hand refused it.
    Refused {
        /// Text of the reason as stored in recordings; older programs may have used other texts.
        reason: String,
    },
    /// No usable answer: it is unknown if the hand acted.
    Unanswered,
}

/// Reason why a request for a setting, a SAVE or a reset was not sent. Nothing changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotSent {
    /// Settings are not changed while setpoints pass.
    #[error("the hand is armed: disarm it first")]
    Armed,
    /// A stop has the wire.
    #[error("a stop is still being confirmed")]
    Holding,
    /// A joint moves, or moved within the last second.
    #[error("the hand moves: wait until it rests")]
    Moving,
    /// It is unknown if the hand rests.
    #[error("whether the hand is at rest is unknown: its status or angles are missing or stale")]
    RestUnknown,
    /// The result of an earlier SAVE could be mistaken for that of this one.
    #[error("the last SAVE was just now: wait {} s", .wait.as_secs_f64().ceil())]
    TooSoon {
        /// Remaining wait.
        wait: Duration,
    },
}

/// A group that was written and read back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    pub span: Span,
    pub verdict: Verdict,
    /// Current memory of the hand; `None` if it could not be read back.
    pub holds: Option<Vec<u8>>,
}

/// The outcome of a write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// Read back as written: in effect, acknowledged or not. Not in flash before a SAVE.
    Applied,
    /// The hand, or the rule against unsafe writes, refused it, and the hand holds something else.
    Refused { reason: Refusal },
    /// The hand did not refuse it, but holds something else: it ignored or changed the value.
    Differs,
    /// The hand's current value is unknown.
    Unverified { why: Doubt },
    /// Nothing was written.
    NotSent(NotSent),
}

/// Reason why a write could not be verified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Doubt {
    /// The verifying reads were not answered.
    #[error("the hand did not answer when its value was read back")]
    NotReadBack,
    /// A late reply to an earlier read could have been mistaken for the answer.
    #[error("a late answer could have been mistaken for the value read back")]
    Ambiguous,
    #[error("the link was lost")]
    LinkLost,
}

/// The known outcome of a SAVE.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Saved {
    /// The hand's second frame confirms that the parameters are in flash (manual 2.2.2; RS485 only).
    Confirmed,
    /// The hand's second frame reports a failure.
    Failed {
        /// The value in the frame; 255 by the manual.
        code: u8,
    },
    /// Acknowledged, and the parameters read the same before and after. Only RS485 reports more: on other wires only the next
    /// power-up shows the content of the flash.
    ReadBack,
    /// It is unknown if anything was written to flash.
    Unknown { why: SaveDoubt },
    /// The hand, or the rule against unsafe writes, refused it.
    Refused { reason: Refusal },
    /// SAVE was not sent.
    NotSent(NotSent),
}

impl Saved {
    /// True unless it is known that nothing was written to flash.
    pub const fn may_be_in_flash(&self) -> bool {
        matches!(
            self,
            Self::Confirmed | Self::ReadBack | Self::Unknown { .. }
        )
    }
}

/// Reason why the result of a SAVE is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SaveDoubt {
    /// It was acknowledged, but no second frame arrived in time.
    #[error("the hand acknowledged it, but no result came within 3 s")]
    NoResult,
    /// It was not even acknowledged.
    #[error("the hand neither acknowledged it nor gave a result")]
    Unanswered,
    /// It was acknowledged, but then the parameters could not be read, or had changed.
    #[error("the hand acknowledged it, but its parameters did not read back unchanged")]
    NotReadBack,
    /// The link was lost before the result.
    #[error("the link was lost before the result")]
    LinkLost,
}

/// The outcome of a factory reset.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reset {
    /// The hand acknowledged it.
    Acknowledged,
    /// The hand, or the rule against unsafe writes, refused it.
    Refused {
        reason: Refusal,
    },
    /// No acknowledgement arrived: the hand may have acted, and may have a different address now.
    Unanswered,
    NotSent(NotSent),
}

/// The outcome of a calibration of the force sensors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Calibrated {
    /// The hand's second frame reports the end (RS485 only).
    Finished,
    /// Acknowledged, and the line was left idle for longer than a calibration takes. No frame confirmed it.
    Quiet,
    /// The hand refused it.
    Refused {
        reason: Refusal,
    },
    /// It is unknown if the sensors were calibrated.
    Unknown {
        why: SaveDoubt,
    },
    NotSent(NotSent),
}
