//! The outcome of writing a setting, of a SAVE, and of a return to the factory parameters. Plain values; nothing is sent here.

use crate::hand::command::WRITE_LEN_MAX;
use crate::hand::register::ANGLE_SET;
use crate::hand::{Angle, PerDof, Refusal, RegisterWrite, Span};
use arrayvec::ArrayVec;
use std::time::Duration;

/// Memory as it was written. It is of the past: no register write can be made of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenMemory {
    /// The first byte's address.
    pub address: u16,
    /// The bytes in memory order.
    pub bytes: ArrayVec<u8, WRITE_LEN_MAX>,
}

impl WrittenMemory {
    /// Where it was written.
    pub fn span(&self) -> Span {
        Span::new(
            self.address,
            u16::try_from(self.bytes.len()).unwrap_or_default(),
        )
    }
}

impl WrittenMemory {
    /// The targets of the joints that it sets; `None` where it leaves a joint alone or is about something else.
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

/// Why something was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WriteCause {
    /// A stop, or its repetition.
    Hold,
    /// The limits of speed and force that arming begins with.
    Arming,
    /// A setpoint of whoever may move the hand.
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

    /// The stable word for it in files.
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

/// What became of a write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WriteFate {
    /// The hand acknowledged it. It does not say that the value is in force.
    Acknowledged,
    /// The hand said no.
    Refused {
        /// Its words, as recordings keep them; older programs may have used others.
        reason: String,
    },
    /// No usable answer: whether the hand acted is not known.
    Unanswered,
}

/// Why a request for a setting, a SAVE or a reset was not sent. Nothing changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotSent {
    /// Settings are not touched while setpoints pass.
    #[error("the hand is armed: disarm it first")]
    Armed,
    /// A stop has the wire.
    #[error("a stop is still being confirmed")]
    Holding,
    /// A joint moves, or did a second ago.
    #[error("the hand moves: wait until it rests")]
    Moving,
    /// Whether it rests is not known.
    #[error("it is not known whether the hand rests: its status or angles are missing or old")]
    RestUnknown,
    /// The result of an earlier SAVE could be taken for that of this one.
    #[error("the last SAVE was just now: wait {} s", .wait.as_secs_f64().ceil())]
    TooSoon {
        /// How long to wait.
        wait: Duration,
    },
}

/// A group that was written and read back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The group.
    pub span: Span,
    /// The outcome.
    pub verdict: Verdict,
    /// What the hand holds now, as far as it could be read back.
    pub holds: Option<Vec<u8>>,
}

/// The outcome of a write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// Read back as written: in effect, acknowledged or not. Not in flash before a SAVE.
    Applied,
    /// The hand, or the rule against unsafe writes, said no, and the hand holds something else.
    Refused { reason: Refusal },
    /// The hand did not say no, and holds something else: dropped, or taken as another value.
    Differs,
    /// What the hand holds is not known.
    Unverified { why: Doubt },
    /// Nothing was written.
    NotSent(NotSent),
}

/// Why a write could not be verified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Doubt {
    /// The reads that were to verify it were not answered.
    #[error("the hand did not answer when its value was read back")]
    NotReadBack,
    /// A late reply to an earlier read could have been mistaken for the answer.
    #[error("a late answer could have been mistaken for the value read back")]
    Ambiguous,
    #[error("the link was lost")]
    LinkLost,
}

/// What is known of a SAVE.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Saved {
    /// The hand's second frame says that the parameters are in flash (manual 2.2.2; RS485 only).
    Confirmed,
    /// The hand's second frame says that they are not.
    Failed {
        /// The value in the frame; 255 by the manual.
        code: u8,
    },
    /// Acknowledged, and the parameters read the same before and after. No wire but RS485 tells more: only the next
    /// power-up shows what is in flash.
    ReadBack,
    /// Whether anything was written to flash is not known.
    Unknown { why: SaveDoubt },
    /// The hand, or the rule against unsafe writes, said no.
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

/// Why the result of a SAVE is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SaveDoubt {
    /// It was acknowledged, and no second frame came in time.
    #[error("the hand acknowledged it, but no result came within 3 s")]
    NoResult,
    /// It was not even acknowledged.
    #[error("the hand neither acknowledged it nor gave a result")]
    Unanswered,
    /// Acknowledged, and then the parameters could not be read or read otherwise than before.
    #[error("the hand acknowledged it, but its parameters did not read back unchanged")]
    NotReadBack,
    /// The link was lost before anything was known.
    #[error("the link was lost before the result")]
    LinkLost,
}

/// The outcome of a return to the factory parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reset {
    /// The hand acknowledged it.
    Acknowledged,
    /// The hand, or the rule against unsafe writes, said no.
    Refused {
        reason: Refusal,
    },
    /// No acknowledgement came: it may have acted, and the hand may be elsewhere now.
    Unanswered,
    NotSent(NotSent),
}

/// The outcome of a calibration of the force sensors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Calibrated {
    /// The hand's second frame says that it is finished (RS485 only).
    Finished,
    /// Acknowledged, and the line was left alone for longer than it takes. No frame said so.
    Quiet,
    /// The hand said no.
    Refused {
        reason: Refusal,
    },
    /// Whether the sensors were calibrated is not known.
    Unknown {
        why: SaveDoubt,
    },
    NotSent(NotSent),
}
