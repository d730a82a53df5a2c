//! What a link tells, one thing after the other.

use crate::hand::{Groups, HandSample, Moment};
use crate::record::state::{ArmRefusal, LinkState};
use crate::record::write::{WriteCause, WriteFate, WrittenMemory};
use std::sync::Arc;

/// One thing that happened at a hand. Records of one hand come in the order in which they happened.
#[derive(Debug, Clone, PartialEq)]
pub enum Record {
    /// Something was read.
    Reading {
        /// The newest of everything, this reading included.
        sample: Arc<HandSample>,
        /// What this reading brought.
        fresh: Groups,
    },
    /// The link went from one state to another.
    State {
        at: Moment,
        /// The new one.
        state: LinkState,
    },
    /// A write left for the hand.
    Sent {
        at: Moment,
        /// Its number on this connection, for its fate.
        number: u64,
        /// Why it was written.
        cause: WriteCause,
        write: WrittenMemory,
    },
    /// What became of a write.
    Answered {
        /// When that was known.
        at: Moment,
        /// The number given at sending.
        number: u64,
        /// What became of it.
        fate: WriteFate,
    },
    /// The user asked to arm and may not yet.
    ArmRefused {
        at: Moment,
        /// Why.
        reason: ArmRefusal,
    },
}

impl Record {
    /// When it was received, sent, or happened.
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
