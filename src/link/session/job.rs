//! Requests in progress.

use crate::hand::{Span, Writes};
use crate::link::request::{Answer, Request, RequestError};

/// Writes that are sent one per step.
pub(crate) struct WriteJob {
    pub(crate) writes: Writes,
    /// The hand's pose at that time becomes its target before the first write.
    pub(crate) holds_first: bool,
    pub(crate) is_motion: bool,
    pub(crate) answer: Answer<()>,
}

/// A read of an arbitrary memory range.
pub(crate) struct ReadJob {
    pub(crate) span: Span,
    /// Another reply was requested in between, so this one cannot be mistaken for a duplicate of the last.
    pub(crate) cleared: bool,
    pub(crate) answer: Answer<Vec<u8>>,
}

/// A request in progress.
pub(crate) enum SessionJob {
    Write(WriteJob),
    Read(ReadJob),
    /// A request that needs exclusive use of the line.
    Alone(Request),
}

impl SessionJob {
    /// True if the request moves the hand.
    pub(crate) const fn is_motion(&self) -> bool {
        matches!(self, Self::Write(job) if job.is_motion)
    }

    /// Reports that the request was not completed. The requester may have dropped its receiver.
    pub(crate) fn fail(self, error: RequestError) {
        let _sent = match self {
            Self::Write(job) => job.answer.send(Err(error)).is_ok(),
            Self::Read(job) => job.answer.send(Err(error)).is_ok(),
            Self::Alone(request) => return request.fail(error),
        };
    }
}
