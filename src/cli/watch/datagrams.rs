//! Samples as datagrams, one JSON object each, for programs that plot them.

use anyhow::Context as _;
use serde_json::{Value, json};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};

/// Sender of samples. A receiver is not required.
pub(crate) struct Datagrams {
    socket: UdpSocket,
    sent: u64,
    not_sent: u64,
}

impl Datagrams {
    /// Opens a socket that sends to this address and ignores replies.
    pub(crate) fn to(to: SocketAddr) -> anyhow::Result<Self> {
        let from: SocketAddr = match (to, to.ip().is_loopback()) {
            (SocketAddr::V4(_), true) => (Ipv4Addr::LOCALHOST, 0).into(),
            (SocketAddr::V4(_), false) => (Ipv4Addr::UNSPECIFIED, 0).into(),
            (SocketAddr::V6(_), true) => (Ipv6Addr::LOCALHOST, 0).into(),
            (SocketAddr::V6(_), false) => (Ipv6Addr::UNSPECIFIED, 0).into(),
        };
        let open = || {
            let socket = UdpSocket::bind(from)?;
            socket.set_nonblocking(true)?;
            socket.connect(to)?;
            Ok::<_, std::io::Error>(socket)
        };
        Ok(Self {
            socket: open().with_context(|| format!("cannot send to {to}"))?,
            sent: 0,
            not_sent: 0,
        })
    }

    /// Sends a sample. A failed one is counted and not repeated.
    pub(crate) fn send(&mut self, sample: &Value) {
        match self.socket.send(sample.to_string().as_bytes()) {
            Ok(_bytes) => self.sent += 1,
            Err(_refused) => self.not_sent += 1,
        }
    }

    /// Numbers of datagrams, for the last line of statistics.
    pub(crate) fn figures(&self) -> Value {
        json!({"sent": self.sent, "not_sent": self.not_sent})
    }
}
