//! Listening addresses of a command: parsing, and messages to the user.

use crate::cli::out::notify;
use anyhow::anyhow;
use std::io;
use std::net::SocketAddr;

/// A numeric address with a port; 0 selects a free one.
pub(crate) fn address(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_not_one| {
        "write an address in numbers and a port, for example 127.0.0.1:6000".to_owned()
    })
}

/// Error of a failed listen.
pub(crate) fn refused(at: SocketAddr, error: &io::Error) -> anyhow::Error {
    anyhow!("cannot listen on {at}: {error}; choose another address or port")
}

/// Warns about an address that other computers can reach; `can` describes what they could do.
pub(crate) fn warn_if_reachable(at: SocketAddr, can: &str) {
    if !at.ip().is_loopback() {
        notify(&format!(
            "warning: anyone in the network can reach {at} and {can}; 127.0.0.1 keeps it to this computer"
        ));
    }
}
