//! From the system's error on an open wire to the words a person reads. Shared by the protocols; nothing is retried here.

use crate::link::bus::BusError;
use crate::transport::TransportError;
use std::io;

/// The end of a wire: it hung up, or failed as it says.
pub(crate) fn lost(place: &str, error: &io::Error) -> BusError {
    let place = place.to_owned();
    let told = error.get_ref().and_then(|inner| inner.downcast_ref());
    if let Some(told) = told {
        return BusError::Lost(TransportError::clone(told));
    }
    // A pseudo-terminal says EIO and a USB adapter ENXIO or EPIPE when the other side goes.
    let hung_up = matches!(
        error.kind(),
        io::ErrorKind::BrokenPipe | io::ErrorKind::UnexpectedEof | io::ErrorKind::ConnectionReset
    ) || matches!(error.raw_os_error(), Some(5 | 6));
    BusError::Lost(if hung_up {
        TransportError::HungUp { place }
    } else {
        TransportError::Io {
            place,
            message: error.to_string(),
        }
    })
}
