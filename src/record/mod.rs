//! What happened at a hand, as typed values that a file can hold.

pub mod quirk_sheet;
pub mod state;
pub mod write;

pub use crate::record::quirk_sheet::{Fact, QuirkSheet};
pub use crate::record::state::{ArmRefusal, Disarmed, Hold, LinkState, Rest};
pub use crate::record::write::{
    Calibrated, Doubt, NotSent, Reset, SaveDoubt, Saved, Verdict, Written,
};

use crate::hand::{Groups, HandSample, Moment, RegisterWrite};
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
        /// What was written.
        write: RegisterWrite,
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

/// What became of a write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WriteFate {
    /// The hand acknowledged it. It does not say that the value is in force.
    Acknowledged,
    /// The hand said no.
    Refused {
        /// The protocol's word for it.
        reason: String,
    },
    /// No usable answer: whether the hand acted is not known.
    Unanswered,
}
