//! Simulated hands behind a pseudo-terminal, where other programs open it like a serial port. Unix only.

use crate::sim::serve::hands::Hands;
use crate::sim::serve::modbus_rtu;
use crate::sim::serve::rs485;
use crate::sim::serve::slcan;
use crate::transport::{PtyLink, TransportError};
use std::future::Future;
use std::io;
use std::path::Path;

/// Makes the link at `path` at once, and answers there while the returned future lives. Clients may come and go;
/// dropping the future removes the link.
///
/// # Errors
/// As [`PtyLink::create`]: something that is no link stands there, no permission, no such folder. Must be called
/// within a tokio runtime.
pub fn serve_rs485(
    hands: impl Into<Hands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(rs485::serve(hands.into(), link))
}

/// As [`serve_rs485`], in Modbus RTU. The future ends with an error only if the system has no pseudo-terminals left.
///
/// # Errors
/// As [`serve_rs485`].
pub fn serve_rtu(
    hands: impl Into<Hands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = io::Result<()>> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(modbus_rtu::serve(hands.into(), link))
}

/// As [`serve_rs485`], with the hand behind a serial CAN adapter.
///
/// # Errors
/// As [`serve_rs485`].
pub fn serve_slcan(
    hands: impl Into<Hands> + Send + 'static,
    path: &Path,
) -> Result<impl Future<Output = ()> + Send + 'static, TransportError> {
    let link = PtyLink::create(path)?;
    Ok(slcan::serve(hands.into(), link))
}
