//! A serial line that forwards only the reply to the open request to the Modbus client, and that its bus can listen to
//! between requests. Does not decide which requests are sent.

use crate::codec::NoiseCounts;
use crate::codec::modbus_rtu::{FRAME_LEN_MAX, RtuReply, RtuSplitter};
use crate::link::bus::echo::Echo;
use crate::transport::BoxedWire;
use arrayvec::ArrayVec;
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, ready};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::Instant;

/// Maximum bytes per read from the wire.
const CHUNK: usize = FRAME_LEN_MAX;

/// Expected form of a reply. Replies have no number, so this is the only way to match them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RtuReplyShape {
    /// Function 03 with this many bytes.
    Bytes(u16),
    /// Function 06 at this address.
    Single([u8; 2]),
    /// Function 16: address and count.
    Multiple([u8; 4]),
}

impl RtuReplyShape {
    fn to(request: &[u8]) -> Option<Self> {
        match request {
            [_, 3, _, _, high, low, ..] => Some(Self::Bytes(
                u16::from_be_bytes([*high, *low]).checked_mul(2)?,
            )),
            [_, 6, high, low, ..] => Some(Self::Single([*high, *low])),
            [_, 16, a, b, c, d, ..] => Some(Self::Multiple([*a, *b, *c, *d])),
            _ => None,
        }
    }

    fn fits(self, reply: &RtuReply) -> bool {
        match (self, reply.bytes.as_slice()) {
            (Self::Bytes(_), [_, 0x83, ..])
            | (Self::Single(_), [_, 0x86, ..])
            | (Self::Multiple(_), [_, 0x90, ..]) => true,
            (Self::Bytes(len), _) => reply.read_len() == Some(len),
            // Manual: 2.4.2 prints zeros in the reply to FC06 where the standard echoes; both pass.
            (Self::Single(address), [_, 6, rest @ ..]) => {
                rest.starts_with(&address) || rest.starts_with(&[0; 4])
            }
            (Self::Multiple(written), [_, 16, rest @ ..]) => rest.starts_with(&written),
            _ => false,
        }
    }
}

/// The line, shared by the client and the bus. Locked for one poll, never across a wait.
#[derive(Clone)]
pub(crate) struct RtuLine(Arc<Mutex<RtuRelay>>);

struct RtuRelay {
    wire: BoxedWire,
    splitter: RtuSplitter,
    open: Option<RtuReplyShape>,
    /// The request being sent, and the number of its bytes already written.
    request: ArrayVec<u8, FRAME_LEN_MAX>,
    written: usize,
    /// The reply being forwarded to the client.
    passed: ArrayVec<u8, FRAME_LEN_MAX>,
    foreign: u64,
    echo: Echo,
    echoes: u64,
    closed: bool,
    last_byte_at: Option<Instant>,
}

impl RtuLine {
    pub(crate) fn new(wire: BoxedWire, unit: u8) -> Self {
        Self(Arc::new(Mutex::new(RtuRelay {
            wire,
            splitter: RtuSplitter::new(unit),
            open: None,
            request: ArrayVec::new(),
            written: 0,
            passed: ArrayVec::new(),
            foreign: 0,
            echo: Echo::default(),
            echoes: 0,
            closed: false,
            last_byte_at: None,
        })))
    }

    /// Waits for bytes and sorts them. Safe to cancel. The end of the wire is an error.
    pub(crate) async fn receive(&self) -> io::Result<()> {
        std::future::poll_fn(|cx| self.line().poll_receive(cx)).await
    }

    /// Drops the open request, and its unsent rest: a reply to it is foreign from now on.
    pub(crate) fn abandon(&self) {
        let mut line = self.line();
        line.open = None;
        line.request.clear();
        line.written = 0;
        line.passed.clear();
    }

    /// Called when the line is silent: drops an incomplete frame, and forwards a complete reply behind it.
    pub(crate) fn flush_pending(&self) {
        let mut line = self.line();
        line.splitter.flush_pending();
        line.sort();
    }

    /// Unrequested replies since the line was opened.
    pub(crate) fn foreign(&self) -> u64 {
        self.line().foreign
    }

    /// Requests of other controllers since the line was opened.
    pub(crate) fn foreign_requests(&self) -> u64 {
        self.line().splitter.requests().foreign
    }

    /// True if the adapter echoes what is sent.
    pub(crate) fn echoes(&self) -> bool {
        self.line().echo.is_sure()
    }

    /// Number of echoes since the line was opened.
    pub(crate) fn own_frames(&self) -> u64 {
        self.line().splitter.requests().echoes
    }

    /// Skipped noise since the line was opened.
    pub(crate) fn noise(&self) -> NoiseCounts {
        self.line().splitter.noise()
    }

    /// Time of the last byte.
    pub(crate) fn last_byte_at(&self) -> Option<Instant> {
        self.line().last_byte_at
    }

    /// True once the other side closed the wire.
    pub(crate) fn closed(&self) -> bool {
        self.line().closed
    }

    fn line(&self) -> MutexGuard<'_, RtuRelay> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl RtuRelay {
    fn poll_receive(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        let mut chunk = [0; CHUNK];
        let mut buffer = ReadBuf::new(&mut chunk);
        ready!(Pin::new(&mut self.wire).poll_read(cx, &mut buffer))?;
        if buffer.filled().is_empty() {
            self.closed = true;
            return Poll::Ready(Err(io::ErrorKind::UnexpectedEof.into()));
        }
        self.last_byte_at = Some(Instant::now());
        let mut bytes = buffer.filled();
        while !bytes.is_empty() {
            let taken = self.splitter.push(bytes);
            bytes = bytes.get(taken..).unwrap_or_default();
            self.sort();
        }
        Poll::Ready(Ok(()))
    }

    /// Forwards the reply to the open request; counts and drops all others.
    fn sort(&mut self) {
        while let Some(reply) = self.splitter.next() {
            self.note_echo();
            if self.open.is_some_and(|open| open.fits(&reply)) {
                self.open = None;
                self.echo.answered();
                self.passed = reply.bytes;
            } else {
                self.foreign += 1;
            }
        }
    }

    fn note_echo(&mut self) {
        let echoes = self.splitter.requests().echoes;
        if echoes > self.echoes {
            self.echoes = echoes;
            self.echo.came_back();
        }
    }

    /// Expects the echo of a request that is sent now. The reply to function 06 resembles its request: there an echo is
    /// expected only if the previous exchange had one, and each session begins with reads.
    fn expect_echo(&mut self, request: &[u8]) {
        self.note_echo();
        self.echo.sent();
        let looks_like_its_reply = matches!(request, [_, 6, ..]);
        if looks_like_its_reply && !self.echo.is_likely() {
            self.splitter.expect_no_echo();
        } else {
            self.splitter.expect_echo(request);
        }
    }

    /// Writes the rest of the request to the wire.
    fn poll_send(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        while let Some(rest @ [_, ..]) = self.request.get(self.written..) {
            match ready!(Pin::new(&mut self.wire).poll_write(cx, rest))? {
                0 => return Poll::Ready(Err(io::ErrorKind::WriteZero.into())),
                written => self.written += written,
            }
        }
        self.request.clear();
        self.written = 0;
        Pin::new(&mut self.wire).poll_flush(cx)
    }
}

impl AsyncRead for RtuLine {
    fn poll_read(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let mut line = self.line();
        while line.passed.is_empty() {
            ready!(line.poll_receive(cx))?;
        }
        let len = line.passed.len().min(into.remaining());
        into.put_slice(line.passed.get(..len).unwrap_or_default());
        line.passed.drain(..len);
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for RtuLine {
    /// Accepts the whole request, so that none of it remains in the client if the wire is slow.
    fn poll_write(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        request: &[u8],
    ) -> Poll<io::Result<usize>> {
        let mut line = self.line();
        ready!(line.poll_send(cx))?;
        if line.request.try_extend_from_slice(request).is_err() {
            return Poll::Ready(Err(io::ErrorKind::InvalidInput.into()));
        }
        line.open = RtuReplyShape::to(request);
        line.expect_echo(request);
        line.passed.clear();
        Poll::Ready(Ok(request.len()))
    }

    fn poll_flush(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.line().poll_send(cx)
    }

    fn poll_shutdown(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.line().wire).poll_shutdown(cx)
    }
}

impl std::fmt::Debug for RtuLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RtuLine").finish_non_exhaustive()
    }
}
