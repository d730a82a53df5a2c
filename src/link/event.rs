//! What comes out of a link and what may be asked of it. Plain values only.

use crate::hand::{Groups, HandCommand, HandSample, Moment, OutOfRange, Setting, Span};
use crate::link::settled::{Calibrated, Reset, Saved, Written};
use crate::link::status::{ArmRefusal, LinkState};

/// One thing that happened, in order.
#[derive(Debug, Clone, PartialEq)]
pub enum LinkEvent {
    /// Something was read.
    Sample {
        /// The newest of everything.
        sample: Box<HandSample>,
        /// What is new in it.
        fresh: Groups,
    },
    /// The link went from one state to another.
    State {
        /// When.
        at: Moment,
        /// The new one.
        state: LinkState,
    },
    /// A person asked to arm and may not yet.
    ArmRefused {
        /// When.
        at: Moment,
        /// Why.
        reason: ArmRefusal,
    },
    /// A request came to its end.
    Done {
        /// The number given at asking.
        ticket: Ticket,
        /// How it ended.
        result: Result<Outcome, RequestError>,
    },
}

/// The number of one request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticket(pub u64);

/// One thing asked of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// Write, then say whether the hand acknowledged.
    Command(HandCommand),
    /// Read some memory.
    Read(Span),
    /// Write one kept group, read it back, and say what came of it.
    Set(Setting),
    /// Write the parameters to flash, and say what is known of it.
    Save,
    /// Return to the factory's parameters. The hand may be found at another id, speed or address afterwards.
    Reset,
    /// Calibrate the force sensors. The line is left to the hand, and nothing arms, until that is over.
    Calibrate,
}

/// How a request ended well.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// The hand acknowledged every write. It does not say that the value is in force.
    Acknowledged,
    /// The memory that was asked for.
    Memory {
        /// Its place.
        span: Span,
        /// Its bytes.
        bytes: Vec<u8>,
    },
    /// What came of a setting.
    Written(Written),
    /// What is known of a SAVE.
    Saved(Saved),
    /// What came of a return to the factory's parameters.
    Reset(Reset),
    /// What came of a calibration.
    Calibrated(Calibrated),
}

/// How a request failed. Nothing is tried again by itself.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RequestError {
    /// There is no live hand. Nothing was sent and nothing waits.
    #[error("not connected: nothing was sent")]
    NotConnected,
    /// A motion that needs arming.
    #[error("not armed: nothing was sent")]
    NotArmed,
    /// Too many requests wait already.
    #[error("{limit} requests wait already: nothing was sent")]
    Full {
        /// The queue's length.
        limit: usize,
    },
    /// This wire cannot carry it.
    #[error("{address}+{len} cannot be asked over this wire in one request")]
    TooLong {
        /// First byte.
        address: u16,
        /// Bytes.
        len: u16,
    },
    /// The hand did not answer in time. Whether it acted is not known.
    #[error(
        "no answer from the hand for address {address} within {after_ms} ms: whether it acted is not known"
    )]
    Timeout {
        /// First byte.
        address: u16,
        /// How long was waited.
        after_ms: u64,
    },
    /// The hand said no.
    #[error("the hand refused address {address}: {reason}")]
    Refused {
        /// First byte.
        address: u16,
        /// The protocol's word for it.
        reason: String,
    },
    /// The hand answered something that does not fit the request.
    #[error("the hand answered {got} bytes to a request for {want} at address {address}")]
    WrongLength {
        /// First byte.
        address: u16,
        /// What came.
        got: usize,
        /// What was asked.
        want: usize,
    },
    /// An earlier, unanswered request for the same address may still be answered, and the two could not be told apart.
    #[error("a late answer for address {address} may still come: ask again in {wait_s} s")]
    Ambiguous {
        /// First byte.
        address: u16,
        /// Seconds to wait.
        wait_s: u64,
    },
    /// The wire broke while it was under way.
    #[error("the link was lost: whether the hand acted is not known")]
    LinkLost,
    /// A value that the hand must not be given.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}
