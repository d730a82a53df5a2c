//! Errors and counts of a bus. Shared by the protocols; nothing is retried here.

use crate::hand::Refusal;
use crate::system::SystemError;
use crate::transport::TransportError;
use arrayvec::ArrayVec;
use std::io;
use std::time::Duration;

/// Maximum bytes of one read over any protocol.
pub(crate) const READ_MAX: usize = 252;

/// The memory bytes of one reply.
pub(crate) type Bytes = ArrayVec<u8, READ_MAX>;

/// Reason why a request failed. Only `Lost` ends the session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum BusError {
    /// No reply in time.
    Timeout { after: Duration },
    /// The hand refused.
    Refused { reason: Refusal },
    /// The reply has another length than requested.
    WrongLength { got: usize, want: usize },
    /// The request is too long for this protocol.
    TooLong,
    /// A late reply could answer the request in every shape.
    Ambiguous,
    /// The wire was lost.
    Lost(TransportError),
}

/// Counts of a bus since it was opened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct BusCounts {
    pub(crate) checksum_errors: u64,
    pub(crate) resyncs: u64,
    pub(crate) foreign_replies: u64,
    /// Replies to requests that had timed out, where they can be identified.
    pub(crate) late_replies: u64,
    pub(crate) foreign_requests: u64,
}

impl BusCounts {
    pub(crate) const fn plus(self, more: Self) -> Self {
        Self {
            checksum_errors: self.checksum_errors + more.checksum_errors,
            resyncs: self.resyncs + more.resyncs,
            foreign_replies: self.foreign_replies + more.foreign_replies,
            late_replies: self.late_replies + more.late_replies,
            foreign_requests: self.foreign_requests + more.foreign_requests,
        }
    }
}

/// Error for a wire that hung up or failed.
pub(crate) fn lost(place: &str, error: &io::Error) -> BusError {
    let place = place.to_owned();
    let cause = error.get_ref().and_then(|inner| inner.downcast_ref());
    if let Some(cause) = cause {
        return BusError::Lost(TransportError::clone(cause));
    }
    // If the other side closes, a pseudo-terminal returns EIO and a USB adapter ENXIO or EPIPE.
    let hung_up = matches!(
        error.kind(),
        io::ErrorKind::BrokenPipe | io::ErrorKind::UnexpectedEof | io::ErrorKind::ConnectionReset
    ) || matches!(error.raw_os_error(), Some(5 | 6));
    BusError::Lost(if hung_up {
        TransportError::HungUp { place }
    } else {
        TransportError::Io {
            place,
            failure: SystemError::from(error).into(),
        }
    })
}
