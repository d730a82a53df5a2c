//! What may be asked of a link, each with the place its answer goes to, and how asking can fail.

use crate::hand::{HandCommand, OutOfRange, Refusal, Setting, Span};
use crate::link::lease::{Lease, LeaseRefusal};
use crate::record::{Calibrated, NotSent, Reset, Saved, Written};
use tokio::sync::oneshot;

/// Where the answer to a request goes. Nobody may be waiting any more; then it is dropped.
pub(crate) type Answer<T> = oneshot::Sender<Result<T, RequestError>>;

/// One thing asked of the hand.
#[derive(Debug)]
pub(crate) enum Request {
    /// Write, under a lease if the hand moves by it; answered once the hand acknowledged every write.
    Command(HandCommand, Option<Lease>, Answer<()>),
    /// Read some memory.
    Read(Span, Answer<Vec<u8>>),
    /// Write one kept group and read it back.
    Set(Setting, Answer<Written>),
    /// Write one kept group at rest; the hand may answer elsewhere then.
    SetUnread(Setting, Answer<()>),
    /// Write the parameters to flash.
    Save(Answer<Saved>),
    /// Return to the factory's parameters.
    Reset(Answer<Reset>),
    /// Calibrate the force sensors.
    Calibrate(Answer<Calibrated>),
}

impl Request {
    /// Answers that it was not done.
    pub(crate) fn fail(self, error: RequestError) {
        // Whoever asked may be gone.
        let _told = match self {
            Self::Command(_, _, answer) => answer.send(Err(error)).is_ok(),
            Self::Read(_, answer) => answer.send(Err(error)).is_ok(),
            Self::Set(_, answer) => answer.send(Err(error)).is_ok(),
            Self::SetUnread(_, answer) => answer.send(Err(error)).is_ok(),
            Self::Save(answer) => answer.send(Err(error)).is_ok(),
            Self::Reset(answer) => answer.send(Err(error)).is_ok(),
            Self::Calibrate(answer) => answer.send(Err(error)).is_ok(),
        };
    }

    /// True if nobody waits for the answer any more.
    pub(crate) fn is_abandoned(&self) -> bool {
        match self {
            Self::Command(_, _, answer) => answer.is_closed(),
            Self::Read(_, answer) => answer.is_closed(),
            Self::Set(_, answer) => answer.is_closed(),
            Self::SetUnread(_, answer) => answer.is_closed(),
            Self::Save(answer) => answer.is_closed(),
            Self::Reset(answer) => answer.is_closed(),
            Self::Calibrate(answer) => answer.is_closed(),
        }
    }
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
    /// A motion under a lease that does not hold.
    #[error(transparent)]
    NotOwner(#[from] LeaseRefusal),
    /// What a hand keeps is not touched now.
    #[error("{0}: nothing was sent")]
    NotNow(NotSent),
    /// Too many requests wait already.
    #[error("{limit} requests wait already: nothing was sent")]
    Full {
        /// Requests that the queue holds.
        limit: usize,
    },
    /// This wire cannot carry it.
    #[error("{address}+{len} cannot be asked over this wire in one request")]
    TooLong {
        /// First byte.
        address: u16,
        /// Number of bytes asked for.
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
        /// The hand's reason.
        reason: Refusal,
    },
    /// The hand answered something that does not fit the request.
    #[error("the hand answered {got} bytes to a request for {want} at address {address}")]
    WrongLength {
        /// First byte.
        address: u16,
        /// Bytes received.
        got: usize,
        /// Bytes expected.
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
