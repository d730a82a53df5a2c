//! Simulated hands behind a pseudo-terminal, which other programs open like a serial port. Unix only.

use crate::sim::serve::hands::SimHands;
use crate::sim::serve::modbus_rtu;
use crate::sim::serve::rs485;
use crate::sim::serve::slcan;
use crate::sim::serve::usbcan;
use crate::transport::{LinePace, PtyLink, TransportError, paced};
use std::future::Future;
use std::path::Path;
use std::time::Duration;

/// Creates the link at `path` at once, and answers there while the returned future lives. Clients may come and go;
/// dropping the future removes the link. With a pace it simulates the timing of a line.
///
/// # Errors
/// As for [`PtyLink::create`]: the path exists and is not a link, no permission, no such folder. Must be called
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

/// Like [`serve_rs485`], in Modbus RTU.
///
/// # Errors
/// As for [`serve_rs485`].
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

/// Creates a line that accepts one speed if a pace is given, else any.
fn line(path: &Path, pace: Option<LinePace>) -> Result<PtyLink, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(match pace {
        Some(pace) => link.at_baud(pace.baud),
        None => link,
    })
}

/// Time from a request on the bus to the reply. The manual names no time for CAN; it is shorter than observed on RS485.
const ON_BUS: Duration = Duration::from_micros(300);
/// Pace of a CAN adapter on USB: its bytes take no less than the frame's bits on a bus of 1 Mbit/s (manual 2.3).
const ADAPTER: LinePace = LinePace {
    baud: 1_000_000,
    turnaround: ON_BUS,
};

/// Like [`serve_rs485`], with the hand behind a serial CAN adapter, with the timing of adapter, bus and hand.
///
/// # Errors
/// As for [`serve_rs485`].
pub fn serve_slcan(
    hands: impl Into<SimHands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    let hands = hands.into();
    Ok(paced(link, ADAPTER, |wire| slcan::serve(hands, wire)))
}

/// Like [`serve_slcan`], with the maker's own adapter.
///
/// # Errors
/// As for [`serve_rs485`].
pub fn serve_usbcan(
    hands: impl Into<SimHands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    let hands = hands.into();
    Ok(paced(link, ADAPTER, |wire| usbcan::serve(hands, wire)))
}
