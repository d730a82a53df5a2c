//! In-memory wires to one simulated hand, and a tap that notes when the link spoke and when it heard.

use crate::setup::hand;
use crate::setup::link;
use handscope::sim::SharedHand;
use handscope::transport::{Dial, Pipe, pair};
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::Instant;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Protocol {
    Rs485,
    Rtu,
    Tcp,
    Can,
}

impl Protocol {
    pub(crate) const ALL: [Self; 4] = [Self::Rs485, Self::Rtu, Self::Tcp, Self::Can];

    /// `unit` is what the hand puts into its replies over TCP.
    pub(crate) fn endpoint(self, unit: u8) -> String {
        match self {
            Self::Rs485 => "rs485:test".to_owned(),
            Self::Rtu => "rtu:test".to_owned(),
            Self::Tcp => format!("tcp:test?unit={unit}"),
            Self::Can => "can:test".to_owned(),
        }
    }
}

/// When the link sent something, and when something came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Noted {
    Sent(Instant),
    Heard(Instant),
    /// A new wire.
    Dialled,
}

pub(crate) type Notes = Arc<Mutex<Vec<Noted>>>;

/// Opens wires to a hand, each with a tap at our end.
pub(crate) fn dial(hand: &SharedHand, notes: &Notes) -> Arc<dyn Dial> {
    let (hand, notes) = (hand.clone(), Arc::clone(notes));
    link::dial(move |endpoint| {
        let (near, far) = pair();
        hand::serve(hand.clone(), endpoint, far);
        notes.lock().unwrap().push(Noted::Dialled);
        let notes = Arc::clone(&notes);
        link::opened(Tap { near, notes })
    })
}

struct Tap {
    near: Pipe,
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
