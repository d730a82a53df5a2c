//! A wire that is used by one protocol after another, and records whether any data was received. Sends nothing by itself.

use crate::transport::BoxedWire;
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

/// Bytes kept of each direction, to detect an echo: longer than any request of a scan.
const BYTES_MAX: usize = 64;

/// One open wire with several users in turn. It closes when the last of them is dropped.
#[derive(Clone)]
pub(crate) struct LentWire(Arc<Mutex<ObservedWire>>);

struct ObservedWire {
    wire: BoxedWire,
    sent: Vec<u8>,
    received: Vec<u8>,
    received_bytes: usize,
}

impl LentWire {
    pub(crate) fn new(wire: BoxedWire) -> Self {
        Self(Arc::new(Mutex::new(ObservedWire {
            wire,
            sent: Vec::new(),
            received: Vec::new(),
            received_bytes: 0,
        })))
    }

    /// Bytes received since the last call; 0 if they are only an echo of what was sent.
    pub(crate) fn take_received(&self) -> usize {
        let mut line = self.line();
        let echo = line.sent == line.received && line.received_bytes == line.received.len();
        let received = if echo { 0 } else { line.received_bytes };
        line.sent.clear();
        line.received.clear();
        line.received_bytes = 0;
        received
    }

    fn line(&self) -> MutexGuard<'_, ObservedWire> {
        // A panic of its user leaves the line consistent: no operation on it can be half done.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn keep(kept: &mut Vec<u8>, bytes: &[u8]) {
    let room = BYTES_MAX.saturating_sub(kept.len());
    kept.extend(bytes.iter().take(room));
}

impl AsyncRead for LentWire {
    fn poll_read(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let mut line = self.line();
        let before = buf.filled().len();
        let polled = Pin::new(&mut line.wire).poll_read(cx, buf);
        let got = buf.filled().get(before..).unwrap_or_default();
        line.received_bytes = line.received_bytes.saturating_add(got.len());
        keep(&mut line.received, got);
        polled
    }
}

impl AsyncWrite for LentWire {
    fn poll_write(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &[u8],
    ) -> Poll<io::Result<usize>> {
        let mut line = self.line();
        let polled = Pin::new(&mut line.wire).poll_write(cx, buf);
        if let Poll::Ready(Ok(put)) = polled {
            keep(&mut line.sent, buf.get(..put).unwrap_or_default());
        }
        polled
    }

    fn poll_flush(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.line().wire).poll_flush(cx)
    }

    fn poll_shutdown(self: Pin<&mut Self>, _cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        // The next user continues with it.
        Poll::Ready(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::pair;
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

    #[tokio::test]
    async fn an_echo_is_not_taken_for_talk() {
        let (near, mut far) = pair();
        let lent = LentWire::new(Box::new(near));
        for (sent, came, received) in [
            (&b"question"[..], &b"question"[..], 0),
            (b"question", b"", 0),
            (b"question", b"questionanswer", 14),
            (b"", b"noise", 5),
            (b"question", &[7; 100], 100),
        ] {
            let mut user = lent.clone();
            user.write_all(sent).await.unwrap();
            user.shutdown().await.unwrap();
            far.write_all(came).await.unwrap();
            let mut got = vec![0; came.len()];
            user.read_exact(&mut got).await.unwrap();
            assert_eq!(lent.take_received(), received, "{came:?}");
            let mut rest = vec![0; sent.len()];
            far.read_exact(&mut rest).await.unwrap();
        }
        drop(lent);
        assert_eq!(
            far.read(&mut [0]).await.unwrap(),
            0,
            "closed with the last user"
        );
    }
}
