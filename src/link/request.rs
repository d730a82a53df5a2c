//! Requests to a link, each with the channel for its reply, and their errors.

use crate::hand::{HandCommand, OutOfRange, Refusal, Setting, Span};
use crate::link::lease::{Lease, LeaseRefusal};
use crate::record::{Calibrated, NotSent, Reset, Saved, Written};
use tokio::sync::oneshot;

/// Channel for the reply to a request. The reply is dropped if the receiver is gone.
pub(crate) type Answer<T> = oneshot::Sender<Result<T, RequestError>>;

/// One request to the hand.
#[derive(Debug)]
pub(crate) enum Request {
    /// Write, under a lease if the hand moves by it; answered once the hand acknowledged every write.
    Command(HandCommand, Option<Lease>, Answer<()>),
    /// Read a range of memory.
    Read(Span, Answer<Vec<u8>>),
    /// Write one persistent group and read it back.
    Set(Setting, Answer<Written>),
    /// Write one persistent group at rest; the hand may answer elsewhere afterwards.
    SetUnread(Setting, Answer<()>),
    /// Write the parameters to flash.
    Save(Answer<Saved>),
    /// Restore the factory parameters.
    Reset(Answer<Reset>),
    /// Calibrate the force sensors.
    Calibrate(Answer<Calibrated>),
}

impl Request {
    /// Reports that the request was not done.
    pub(crate) fn fail(self, error: RequestError) {
        // The requester may have dropped its receiver.
        let _sent = match self {
            Self::Command(_, _, answer) => answer.send(Err(error)).is_ok(),
            Self::Read(_, answer) => answer.send(Err(error)).is_ok(),
            Self::Set(_, answer) => answer.send(Err(error)).is_ok(),
            Self::SetUnread(_, answer) => answer.send(Err(error)).is_ok(),
            Self::Save(answer) => answer.send(Err(error)).is_ok(),
            Self::Reset(answer) => answer.send(Err(error)).is_ok(),
            Self::Calibrate(answer) => answer.send(Err(error)).is_ok(),
        };
    }

    /// True if the requester dropped its receiver.
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

/// Reason why a request failed. Nothing is retried automatically.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RequestError {
    /// There is no live hand. Nothing was sent or queued.
    #[error("not connected: nothing was sent")]
    NotConnected,
    /// A motion without the arming that it needs.
    #[error("not armed: nothing was sent")]
    NotArmed,
    /// A motion under an invalid lease.
    #[error(transparent)]
    NotOwner(#[from] LeaseRefusal),
    /// Persistent settings cannot be changed now.
    #[error("{0}: nothing was sent")]
    NotNow(NotSent),
    /// The request queue is full.
    #[error("{limit} requests are already queued: nothing was sent")]
    Full {
        /// Capacity of the queue.
        limit: usize,
    },
    /// The request is too long for this wire.
    #[error("{address}+{len} does not fit in one request on this wire")]
    TooLong {
        /// First byte.
        address: u16,
        /// Number of bytes requested.
        len: u16,
    },
    /// The hand did not answer in time. It may have acted or not.
    #[error(
        "no answer from the hand for address {address} within {after_ms} ms: whether it acted is not known"
    )]
    Timeout {
        /// First byte.
        address: u16,
        /// Time waited, in milliseconds.
        after_ms: u64,
    },
    /// The hand refused.
    #[error("the hand refused address {address}: {reason}")]
    Refused {
        /// First byte.
        address: u16,
        /// The hand's reason.
        reason: Refusal,
    },
    /// The length of the reply does not fit the request.
    #[error("the hand answered {got} bytes to a request for {want} at address {address}")]
    WrongLength {
        /// First byte.
        address: u16,
        /// Bytes received.
        got: usize,
        /// Bytes expected.
        want: usize,
    },
    /// An earlier, unanswered request for the same address may still be answered, and the two replies could not be
    /// distinguished.
    #[error("a late answer for address {address} may still come: ask again in {wait_s} s")]
    Ambiguous {
        /// First byte.
        address: u16,
        /// Seconds to wait.
        wait_s: u64,
    },
    /// The wire broke while the request was in progress.
    #[error("the link was lost: whether the hand acted is not known")]
    LinkLost,
    /// A value outside the range of the hand.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}
