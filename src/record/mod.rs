//! What happened at a hand, as typed values that a file can hold.

pub mod entry;
pub mod export;
pub mod file;
pub mod quirk_sheet;
pub mod state;
pub mod wire;
pub mod write;

pub use crate::record::entry::{Entry, Event, EventKind, LinkReport};
pub use crate::record::quirk_sheet::{Fact, QuirkSheet};
pub use crate::record::state::{ArmRefusal, Disarmed, Hold, LinkState, Rest};
pub use crate::record::wire::{Direction, Piece, PieceKind};
pub use crate::record::write::{
    Calibrated, Doubt, NotSent, Reset, SaveDoubt, Saved, Verdict, WriteCause, WriteFate, Written,
    WrittenMemory,
};

use crate::hand::{Groups, HandSample, Moment};
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
        /// When.
        at: Moment,
        /// The new one.
        state: LinkState,
    },
    /// A write left for the hand.
    Sent {
        /// When.
        at: Moment,
        /// Its number on this connection, for its fate.
        number: u64,
        /// Why it was written.
        cause: WriteCause,
        /// What was written.
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
    /// A person asked to arm and may not yet.
    ArmRefused {
        /// When.
        at: Moment,
        /// Why.
        reason: ArmRefusal,
    },
}

impl Record {
    /// When it was received, sent, or happened.
    #[must_use]
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
