//! In-memory wires to one simulated hand, and a tap that notes when the link spoke and when it heard.

use futures::FutureExt as _;
use futures::future::BoxFuture;
use handscope::sim::SharedHand;
use handscope::sim::serve::{can, modbus_rtu, modbus_tcp, rs485};
use handscope::transport::{BoxedWire, Dial, Endpoint, TransportError};
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, DuplexStream, ReadBuf};
use tokio::time::Instant;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    Rs485,
    Rtu,
    Tcp,
    Can,
}

impl Protocol {
    pub const ALL: [Self; 4] = [Self::Rs485, Self::Rtu, Self::Tcp, Self::Can];

    /// `unit` is what the hand puts into its replies over TCP.
    pub fn endpoint(self, unit: u8) -> Endpoint {
        let text = match self {
            Self::Rs485 => "rs485:test".to_owned(),
            Self::Rtu => "rtu:test".to_owned(),
            Self::Tcp => format!("tcp:test?unit={unit}"),
            Self::Can => "can:test".to_owned(),
        };
        text.parse().unwrap()
    }
}

/// When the link sent something, and when something came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Noted {
    Sent(Instant),
    Heard(Instant),
    /// A new wire.
    Dialled,
}

pub type Notes = Arc<Mutex<Vec<Noted>>>;

pub struct HandDial {
    pub hand: SharedHand,
    pub protocol: Protocol,
    pub notes: Notes,
}

impl Dial for HandDial {
    fn dial(&self, _: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let (near, far) = tokio::io::duplex(4096);
        let hand = self.hand.clone();
        match self.protocol {
            Protocol::Rs485 => drop(tokio::spawn(rs485::serve(hand, far))),
            Protocol::Rtu => drop(tokio::spawn(modbus_rtu::serve(hand, far))),
            Protocol::Tcp => drop(tokio::spawn(modbus_tcp::serve_client(hand, far))),
            Protocol::Can => drop(tokio::spawn(can::serve(hand, far))),
        }
        self.notes.lock().unwrap().push(Noted::Dialled);
        let notes = Arc::clone(&self.notes);
        let wire: BoxedWire = Box::new(Tap { near, notes });
        futures::future::ready(Ok(wire)).boxed()
    }
}

struct Tap {
    near: DuplexStream,
    notes: Notes,
}

impl AsyncRead for Tap {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = into.filled().len();
        let read = Pin::new(&mut self.near).poll_read(context, into);
        if into.filled().len() > before {
            self.notes
                .lock()
                .unwrap()
                .push(Noted::Heard(Instant::now()));
        }
        read
    }
}

impl AsyncWrite for Tap {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.notes.lock().unwrap().push(Noted::Sent(Instant::now()));
        Pin::new(&mut self.near).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.near).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.near).poll_shutdown(context)
    }
}
