//! A wire that forwards only the reply to the newest request. Modbus TCP replies carry the number of their request;
//! late, duplicate and foreign ones are counted and dropped before the client sees them. The delay of late replies is
//! recorded.

use crate::codec::mbap::MbapSplitter;
use crate::hand::ModbusException;
use crate::link::bus::late_replies::LateReply;
use crate::transport::BoxedWire;
use arrayvec::ArrayVec;
use std::collections::VecDeque;
use std::io;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, ready};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::Instant;

/// Maximum bytes per read from the socket.
const CHUNK: usize = 512;
/// Bytes of a header: transaction, protocol, length, unit (manual 2.5).
const HEADER: usize = 7;

/// Maximum timed-out requests kept: those of a second at the shortest wait, and some more.
const ABANDONED_MAX: usize = 32;

/// Counts of the filter; shared with the bus, because the client owns the filter.
#[derive(Debug, Default)]
pub(crate) struct FilterCounts {
    pub(crate) foreign: AtomicU64,
    pub(crate) late: AtomicU64,
    pub(crate) closed: AtomicBool,
    slowest: Mutex<Option<LateReply>>,
}

impl FilterCounts {
    fn came_late(&self, late: LateReply) {
        self.late.fetch_add(1, Ordering::Relaxed);
        let mut slowest = self.slowest.lock().unwrap_or_else(PoisonError::into_inner);
        if slowest.is_none_or(|slowest| slowest.took <= late.took) {
            *slowest = Some(late);
        }
    }

    /// The slowest late reply since the last [`Self::take_slowest`].
    pub(crate) fn slowest(&self) -> Option<LateReply> {
        *self.slowest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns and clears it.
    pub(crate) fn take_slowest(&self) -> Option<LateReply> {
        let mut slowest = self.slowest.lock().unwrap_or_else(PoisonError::into_inner);
        slowest.take()
    }
}

/// Request number and unit that the next reply must carry.
type ReadKey = (u16, u8);

/// The wire with the filter on its reading side.
pub(crate) struct ReplyFilter {
    wire: BoxedWire,
    splitter: MbapSplitter,
    counts: Arc<FilterCounts>,
    open: Option<(ReadKey, Instant)>,
    abandoned: ArrayVec<(ReadKey, Instant), ABANDONED_MAX>,
    /// Bytes of the request that are still to be written, if the wire accepted only a part.
    rest_of_request: usize,
    passed: VecDeque<u8>,
}

impl ReplyFilter {
    pub(crate) fn new(wire: BoxedWire, counts: Arc<FilterCounts>) -> Self {
        Self {
            wire,
            splitter: MbapSplitter::default(),
            counts,
            open: None,
            abandoned: ArrayVec::new(),
            rest_of_request: 0,
            passed: VecDeque::new(),
        }
    }

    /// Applies new bytes from the wire, and forwards the reply to the open request once complete.
    fn sort(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            let taken = self.splitter.push(bytes);
            bytes = bytes.get(taken..).unwrap_or_default();
            let broken = |error| io::Error::new(io::ErrorKind::InvalidData, error);
            while let Some(adu) = self.splitter.next().map_err(broken)? {
                let key = (adu.transaction, adu.unit);
                if self.open.is_some_and(|(open, _)| open == key) {
                    self.open = None;
                    self.passed.extend(adu.bytes);
                } else if let Some(sent) = self.take_abandoned(key) {
                    self.counts.came_late(LateReply {
                        took: sent.elapsed(),
                        exception: exception(&adu.bytes),
                    });
                } else {
                    self.counts.foreign.fetch_add(1, Ordering::Relaxed);
                }
            }
        }
        Ok(())
    }

    /// Send time of the request with this number, if it timed out and was not answered since.
    fn take_abandoned(&mut self, key: ReadKey) -> Option<Instant> {
        let at = self.abandoned.iter().position(|(asked, _)| *asked == key)?;
        Some(self.abandoned.remove(at).1)
    }

    /// Records the number of the request whose first bytes are being written.
    fn note(&mut self, request: &[u8], written: usize) {
        if self.rest_of_request > 0 {
            self.rest_of_request = self.rest_of_request.saturating_sub(written);
            return;
        }
        if let Some([t0, t1, _, _, _, _, unit]) = request.first_chunk::<HEADER>() {
            let key = (u16::from_be_bytes([*t0, *t1]), *unit);
            if let Some(given_up) = self.open.replace((key, Instant::now())) {
                if self.abandoned.is_full() {
                    self.abandoned.remove(0);
                }
                self.abandoned.push(given_up);
            }
            self.passed.clear();
        }
        self.rest_of_request = request.len().saturating_sub(written);
    }
}

/// The exception in a reply, if it is one.
fn exception(adu: &[u8]) -> Option<ModbusException> {
    match adu.get(HEADER..) {
        Some([function, code, ..]) if *function >= 0x80 => Some(ModbusException::of(*code)),
        _ => None,
    }
}

impl AsyncRead for ReplyFilter {
    fn poll_read(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        while this.passed.is_empty() {
            let mut chunk = [0; CHUNK];
            let mut buffer = ReadBuf::new(&mut chunk);
            ready!(Pin::new(&mut this.wire).poll_read(cx, &mut buffer))?;
            if buffer.filled().is_empty() {
                this.counts.closed.store(true, Ordering::Relaxed);
                return Poll::Ready(Ok(()));
            }
            this.sort(buffer.filled())?;
        }
        while into.remaining() > 0 {
            let Some(byte) = this.passed.pop_front() else {
                break;
            };
            into.put_slice(&[byte]);
        }
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for ReplyFilter {
    fn poll_write(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        request: &[u8],
    ) -> Poll<io::Result<usize>> {
        let this = self.get_mut();
        let written = ready!(Pin::new(&mut this.wire).poll_write(cx, request))?;
        this.note(request, written);
        Poll::Ready(Ok(written))
    }

    fn poll_flush(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_flush(cx)
    }

    fn poll_shutdown(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_shutdown(cx)
    }
}

impl std::fmt::Debug for ReplyFilter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ReplyFilter")
            .field("open", &self.open)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

    fn adu(transaction: u16, unit: u8, pdu: &[u8]) -> Vec<u8> {
        let len = u16::try_from(pdu.len() + 1).unwrap();
        let mut bytes = Vec::new();
        bytes.extend(transaction.to_be_bytes());
        bytes.extend([0, 0]);
        bytes.extend(len.to_be_bytes());
        bytes.push(unit);
        bytes.extend(pdu);
        bytes
    }

    #[tokio::test]
    async fn only_the_reply_to_the_newest_request_passes() {
        let (near, mut far) = tokio::io::duplex(4096);
        let counts = Arc::new(FilterCounts::default());
        let mut filter = ReplyFilter::new(Box::new(near), Arc::clone(&counts));
        filter
            .write_all(&adu(6, 255, &[3, 0, 1, 0, 1]))
            .await
            .unwrap();
        filter
            .write_all(&adu(7, 255, &[3, 0, 1, 0, 1]))
            .await
            .unwrap();
        let right = adu(7, 255, &[3, 2, 0xAB, 0xCD]);
        for wrong in [
            adu(6, 255, &[3, 2, 1, 1]),
            adu(7, 1, &[3, 2, 2, 2]),
            adu(8, 255, &[3, 2, 3, 3]),
        ] {
            far.write_all(&wrong).await.unwrap();
        }
        // Split in the middle of the header, and duplicated.
        far.write_all(&right[..3]).await.unwrap();
        far.write_all(&right[3..]).await.unwrap();
        far.write_all(&right).await.unwrap();
        let mut got = vec![0; right.len()];
        filter.read_exact(&mut got).await.unwrap();
        assert_eq!(got, right);
        drop(far);
        assert_eq!(filter.read(&mut got).await.unwrap(), 0);
        assert_eq!(counts.foreign.load(Ordering::Relaxed), 3);
        assert_eq!(counts.late.load(Ordering::Relaxed), 1);
        assert!(counts.closed.load(Ordering::Relaxed));
    }

    #[tokio::test(start_paused = true)]
    async fn a_late_reply_tells_how_late_it_is_and_its_exception_by_its_number() {
        let (near, mut far) = tokio::io::duplex(4096);
        let counts = Arc::new(FilterCounts::default());
        let mut filter = ReplyFilter::new(Box::new(near), Arc::clone(&counts));
        for number in 1..=3 {
            let request = adu(number, 255, &[3, 0, 1, 0, 1]);
            filter.write_all(&request).await.unwrap();
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
        far.write_all(&adu(2, 255, &[0x83, 11])).await.unwrap();
        far.write_all(&adu(1, 255, &[3, 2, 0, 0])).await.unwrap();
        far.write_all(&adu(3, 255, &[3, 2, 0, 0])).await.unwrap();
        let mut got = vec![0; 11];
        filter.read_exact(&mut got).await.unwrap();
        assert_eq!(got, adu(3, 255, &[3, 2, 0, 0]));
        let slowest = counts.take_slowest().unwrap();
        assert_eq!(slowest.took, Duration::from_millis(300));
        assert_eq!(slowest.exception, None);
        assert_eq!(counts.take_slowest(), None);
        assert_eq!(counts.late.load(Ordering::Relaxed), 2);
        let gateway = exception(&adu(2, 255, &[0x83, 11]));
        assert_eq!(gateway, Some(ModbusException::NoAnswer));
    }

    #[tokio::test]
    async fn a_stream_that_is_no_modbus_is_an_error() {
        let (near, mut far) = tokio::io::duplex(4096);
        let mut filter = ReplyFilter::new(Box::new(near), Arc::default());
        filter
            .write_all(&adu(1, 255, &[3, 0, 1, 0, 1]))
            .await
            .unwrap();
        far.write_all(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            .await
            .unwrap();
        let mut got = [0; 16];
        assert!(filter.read(&mut got).await.is_err());
    }
}
