//! Records of a link.

use crate::hand::{Groups, HandSample, Moment};
use crate::record::state::{ArmRefusal, LinkState};
use crate::record::write::{WriteCause, WriteFate, WrittenMemory};
use std::sync::Arc;

/// One event at a hand. Records of one hand are in order of occurrence.
#[derive(Debug, Clone, PartialEq)]
pub enum Record {
    /// A reply of the hand.
    Reading {
        /// The newest value of all groups, including this reading.
        sample: Arc<HandSample>,
        /// Groups updated by this reading.
        fresh: Groups,
    },
    /// The link changed its state.
    State {
        at: Moment,
        /// The new state.
        state: LinkState,
    },
    /// A write left for the hand.
    Sent {
        at: Moment,
        /// Its number on this connection, to which its fate refers.
        number: u64,
        cause: WriteCause,
        write: WrittenMemory,
    },
    /// The outcome of a write.
    Answered {
        /// Time at which it was known.
        at: Moment,
        /// Number of the write.
        number: u64,
        fate: WriteFate,
    },
    /// The user's request to arm was refused.
    ArmRefused {
        at: Moment,
        /// Reason for the refusal.
        reason: ArmRefusal,
    },
}

impl Record {
    /// Time at which it was received, sent, or happened.
    pub fn at(&self) -> Moment {
        match self {
            Self::Reading { sample, fresh } => sample.newest(*fresh).unwrap_or_default(),
            Self::State { at, .. }
            | Self::Sent { at, .. }
            | Self::Answered { at, .. }
            | Self::ArmRefused { at, .. } => *at,
        }
    }
}
