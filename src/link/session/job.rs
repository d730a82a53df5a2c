//! A request that is under way.

use crate::hand::{Span, Writes};
use crate::link::request::{Answer, Request, RequestError};

/// Writes that go out one a step.
pub(crate) struct WriteJob {
    pub(crate) writes: Writes,
    /// Where the hand is by then is made its target before the first write.
    pub(crate) holds_first: bool,
    pub(crate) is_motion: bool,
    pub(crate) answer: Answer<()>,
}

/// A read of any memory.
pub(crate) struct ReadJob {
    pub(crate) span: Span,
    /// Another answer was asked for, so that this one cannot be taken for a double of the last.
    pub(crate) cleared: bool,
    pub(crate) answer: Answer<Vec<u8>>,
}

/// A request that is under way.
pub(crate) enum SessionJob {
    Write(WriteJob),
    Read(ReadJob),
    /// Something that has the line for itself.
    Alone(Request),
}

impl SessionJob {
    /// True if the hand moves because of it.
    pub(crate) const fn is_motion(&self) -> bool {
        matches!(self, Self::Write(job) if job.is_motion)
    }

    /// Answers that it was not done, or not to its end. Whoever asked may be gone.
    pub(crate) fn fail(self, error: RequestError) {
        let _told = match self {
            Self::Write(job) => job.answer.send(Err(error)).is_ok(),
            Self::Read(job) => job.answer.send(Err(error)).is_ok(),
            Self::Alone(request) => return request.fail(error),
        };
    }
}
