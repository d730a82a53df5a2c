//! A request that is under way.

use crate::hand::{RegisterWrite, Span};
use crate::link::request::{Answer, Request, RequestError};
use arrayvec::ArrayVec;

/// Writes of one job: those of the longest command, and the hold before clearing errors.
pub(crate) const JOB_MAX: usize = 7;

/// A request that is under way.
pub(crate) enum SessionJob {
    /// Its writes go out one a step.
    Write {
        writes: ArrayVec<RegisterWrite, JOB_MAX>,
        is_motion: bool,
        answer: Answer<()>,
    },
    Read {
        span: Span,
        /// Another answer was asked for, so that this one cannot be taken for a double of the last.
        cleared: bool,
        answer: Answer<Vec<u8>>,
    },
    /// Something that has the line for itself.
    Alone(Request),
}

impl SessionJob {
    /// True if the hand moves because of it.
    pub(crate) const fn is_motion(&self) -> bool {
        matches!(
            self,
            Self::Write {
                is_motion: true,
                ..
            }
        )
    }

    /// Answers that it was not done, or not to its end. Whoever asked may be gone.
    pub(crate) fn fail(self, error: RequestError) {
        match self {
            Self::Write { answer, .. } => {
                let _told = answer.send(Err(error));
            }
            Self::Read { answer, .. } => {
                let _told = answer.send(Err(error));
            }
            Self::Alone(request) => request.fail(error),
        }
    }
}
