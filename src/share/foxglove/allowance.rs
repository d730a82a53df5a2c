//! A connection that limits the peer's send rate: a peer that exceeds it is disconnected before it slows the link.

use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::Instant;

/// Bytes per second. A viewer sends a kilobyte at the start, and next to nothing after that.
pub const RECEIVED_MAX: usize = 64 * 1024;
const OVER: Duration = Duration::from_secs(1);

/// Counts the bytes read.
#[derive(Debug)]
pub(crate) struct Allowance<S> {
    stream: S,
    since: Instant,
    received: usize,
}

impl<S> Allowance<S> {
    pub(crate) fn new(stream: S) -> Self {
        Self {
            stream,
            since: Instant::now(),
            received: 0,
        }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Allowance<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = into.filled().len();
        ready!(Pin::new(&mut self.stream).poll_read(context, into))?;
        if self.since.elapsed() >= OVER {
            self.since = Instant::now();
            self.received = 0;
        }
        self.received += into.filled().len() - before;
        if self.received > RECEIVED_MAX {
            return Poll::Ready(Err(io::Error::other("says more than a viewer may")));
        }
        Poll::Ready(Ok(()))
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Allowance<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
