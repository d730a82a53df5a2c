//! Simulated hands behind a pseudo-terminal, where other programs open it like a serial port. Unix only.

use crate::sim::serve::hands::SimHands;
use crate::sim::serve::modbus_rtu;
use crate::sim::serve::rs485;
use crate::sim::serve::slcan;
use crate::sim::serve::usbcan;
use crate::transport::{LinePace, PtyLink, TransportError, paced};
use std::future::Future;
use std::path::Path;

/// Makes the link at `path` at once, and answers there while the returned future lives. Clients may come and go;
/// dropping the future removes the link. With a pace it takes the time of a line, else none.
///
/// # Errors
/// As [`PtyLink::create`]: something that is no link stands there, no permission, no such folder. Must be called
/// within a tokio runtime.
pub fn serve_rs485(
    hands: impl Into<SimHands> + Send + 'static,
    path: &Path,
    pace: Option<LinePace>,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let (hands, link) = (hands.into(), line(path, pace)?);
    Ok(async move {
        match pace {
            Some(pace) => paced(link, pace, |wire| rs485::serve(hands, wire)).await,
            None => rs485::serve(hands, link).await,
        }
    })
}

/// As [`serve_rs485`], in Modbus RTU.
///
/// # Errors
/// As [`serve_rs485`].
pub fn serve_rtu(
    hands: impl Into<SimHands> + Send + 'static,
    path: &Path,
    pace: Option<LinePace>,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let (hands, link) = (hands.into(), line(path, pace)?);
    Ok(async move {
        match pace {
            Some(pace) => paced(link, pace, |wire| modbus_rtu::serve(hands, wire)).await,
            None => modbus_rtu::serve(hands, link).await,
        }
    })
}

/// A line that speaks one speed, if it is given, and else any.
fn line(path: &Path, pace: Option<LinePace>) -> Result<PtyLink, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(match pace {
        Some(pace) => link.at_baud(pace.baud),
        None => link,
    })
}

/// As [`serve_rs485`], with the hand behind a serial CAN adapter, which has no pace.
///
/// # Errors
/// As [`serve_rs485`].
pub fn serve_slcan(
    hands: impl Into<SimHands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(slcan::serve(hands.into(), link))
}

/// As [`serve_slcan`], with the maker's own adapter.
///
/// # Errors
/// As [`serve_rs485`].
pub fn serve_usbcan(
    hands: impl Into<SimHands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(usbcan::serve(hands.into(), link))
}
