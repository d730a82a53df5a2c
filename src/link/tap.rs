//! Raw traffic of a wire, in pieces with their times: a bounded ring that the session fills and others read. Nothing is
//! decoded here; `traffic` splits it into frames on demand.

use crate::hand::Moment;
use crate::link::clock::Clock;
use crate::record::{Direction, Piece, PieceKind};
use crate::transport::BoxedWire;
use std::collections::VecDeque;
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

/// Maximum pieces kept: 10 000 frames, of which half come from the hand in up to three pieces each.
pub const PIECES_MAX: usize = 20_000;
/// Maximum bytes kept: 10 000 frames of the usual full poll, some 90 bytes each, and room for the longest.
pub const BYTES_MAX: usize = 1024 * 1024;
/// Maximum pieces returned per call, so that the session never waits long for the lock.
pub const PIECES_AT_ONCE: usize = 2048;

/// Pieces after a position in the stream.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Pieces {
    /// The pieces in order, at most [`PIECES_AT_ONCE`].
    pub pieces: Vec<Piece>,
    /// Position in the stream to continue from.
    pub next: u64,
    /// Pieces that were dropped from the ring before they were read.
    pub lost: u64,
    /// True if further pieces are available.
    pub more: bool,
}

#[derive(Debug, Clone, Copy)]
struct PieceHead {
    at: Moment,
    kind: PieceKind,
    len: usize,
}

#[derive(Debug, Default)]
struct PieceRing {
    heads: VecDeque<PieceHead>,
    bytes: VecDeque<u8>,
    /// Number of the oldest piece in the ring.
    first: u64,
}

impl PieceRing {
    fn push(&mut self, head: PieceHead, bytes: &[u8]) {
        self.heads.push_back(head);
        self.bytes.extend(bytes);
        while self.heads.len() > PIECES_MAX || self.bytes.len() > BYTES_MAX {
            let Some(oldest) = self.heads.pop_front() else {
                break;
            };
            self.bytes.drain(..oldest.len.min(self.bytes.len()));
            self.first += 1;
        }
    }

    fn after(&self, from: u64) -> Pieces {
        let lost = self.first.saturating_sub(from);
        let skip = usize::try_from(from.saturating_sub(self.first)).unwrap_or(usize::MAX);
        let skip = skip.min(self.heads.len());
        let mut at: usize = self.heads.iter().take(skip).map(|head| head.len).sum();
        let mut pieces = Vec::new();
        for head in self.heads.iter().skip(skip).take(PIECES_AT_ONCE) {
            pieces.push(Piece {
                at: head.at,
                kind: head.kind,
                bytes: self.bytes.iter().skip(at).take(head.len).copied().collect(),
            });
            at += head.len;
        }
        let end = skip + pieces.len();
        Pieces {
            pieces,
            next: self.first + u64::try_from(end).unwrap_or_default(),
            lost,
            more: end < self.heads.len(),
        }
    }
}

/// The ring of one link. Copies share it; it outlives the wires that are recorded in it.
#[derive(Debug, Clone, Default)]
pub struct WireTap(Arc<Mutex<PieceRing>>);

impl WireTap {
    /// Pieces recorded after `from`; 0 is the beginning.
    pub fn after(&self, from: u64) -> Pieces {
        self.ring().after(from)
    }

    /// Records bytes, or a change of the wire.
    pub fn record(&self, at: Moment, kind: PieceKind, bytes: &[u8]) {
        let len = bytes.len();
        self.ring().push(PieceHead { at, kind, len }, bytes);
    }

    fn ring(&self) -> MutexGuard<'_, PieceRing> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A recorded wire. Bytes pass unchanged, and no call is delayed by it.
pub(crate) struct TappedWire {
    wire: BoxedWire,
    tap: WireTap,
    clock: Clock,
    broken: bool,
}

impl TappedWire {
    pub(crate) fn new(wire: BoxedWire, tap: WireTap, clock: Clock) -> Self {
        tap.record(clock.now(), PieceKind::Opened, &[]);
        Self {
            wire,
            tap,
            clock,
            broken: false,
        }
    }

    fn passed(&self, direction: Direction, bytes: &[u8]) {
        let kind = PieceKind::Bytes(direction);
        self.tap.record(self.clock.now(), kind, bytes);
    }

    /// Records a broken wire once: it may be polled many times.
    fn broke(&mut self) {
        if !self.broken {
            self.broken = true;
            self.tap.record(self.clock.now(), PieceKind::Broken, &[]);
        }
    }
}

impl Drop for TappedWire {
    fn drop(&mut self) {
        if !self.broken {
            self.tap.record(self.clock.now(), PieceKind::Closed, &[]);
        }
    }
}

impl AsyncRead for TappedWire {
    fn poll_read(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        let before = into.filled().len();
        let polled = Pin::new(&mut this.wire).poll_read(cx, into);
        match &polled {
            Poll::Ready(Ok(())) => match into.filled().get(before..) {
                Some(new) if !new.is_empty() => this.passed(Direction::FromHand, new),
                _ if into.remaining() > 0 => this.broke(),
                _ => {}
            },
            Poll::Ready(Err(_)) => this.broke(),
            Poll::Pending => {}
        }
        polled
    }
}

impl AsyncWrite for TappedWire {
    fn poll_write(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let this = self.get_mut();
        let polled = Pin::new(&mut this.wire).poll_write(cx, bytes);
        match &polled {
            Poll::Ready(Ok(written)) => {
                this.passed(Direction::ToHand, bytes.get(..*written).unwrap_or_default());
            }
            Poll::Ready(Err(_)) => this.broke(),
            Poll::Pending => {}
        }
        polled
    }

    fn poll_flush(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_flush(cx)
    }

    fn poll_shutdown(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_shutdown(cx)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::pair;
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

    const OUT: PieceKind = PieceKind::Bytes(Direction::ToHand);
    const IN: PieceKind = PieceKind::Bytes(Direction::FromHand);

    #[tokio::test(start_paused = true)]
    async fn bytes_pass_unchanged_and_are_noted_with_their_time_until_the_other_side_hangs_up() {
        let (tap, clock) = (WireTap::default(), Clock::start());
        let (ours, mut its) = pair();
        let mut wire = TappedWire::new(Box::new(ours), tap.clone(), clock);
        wire.write_all(b"ask").await.unwrap();
        tokio::time::sleep(std::time::Duration::from_millis(7)).await;
        let mut asked = [0; 3];
        its.read_exact(&mut asked).await.unwrap();
        its.write_all(b"answer").await.unwrap();
        let mut answer = [0; 6];
        wire.read_exact(&mut answer).await.unwrap();
        assert_eq!((&asked, &answer), (b"ask", b"answer"));
        drop(its);
        assert_eq!(wire.read(&mut [0; 9]).await.unwrap(), 0);
        assert_eq!(wire.read(&mut [0; 9]).await.unwrap(), 0);
        drop(wire);
        let noted: Vec<_> = tap.after(0).pieces;
        let pieces: Vec<_> = noted
            .iter()
            .map(|piece| (piece.at.micros(), piece.kind, piece.bytes.as_slice()))
            .collect();
        assert_eq!(
            pieces,
            [
                (0, PieceKind::Opened, &b""[..]),
                (0, OUT, b"ask"),
                (7000, IN, b"answer"),
                (7000, PieceKind::Broken, b""),
            ]
        );
    }

    #[test]
    fn the_ring_forgets_the_oldest_by_count_and_by_bytes_and_says_how_many() {
        let tap = WireTap::default();
        let extra = 25;
        for n in 0..PIECES_MAX + extra {
            let byte = u8::try_from(n % 251).unwrap();
            tap.record(Moment::ZERO, OUT, &[byte, 0]);
        }
        let got = tap.after(0);
        assert_eq!(got.lost, u64::try_from(extra).unwrap());
        assert_eq!(got.pieces.len(), PIECES_AT_ONCE);
        assert_eq!(got.pieces[0].bytes, [25, 0]);
        assert!(got.more);
        let big = WireTap::default();
        for _ in 0..40 {
            big.record(Moment::ZERO, IN, &[7; 65_536]);
        }
        let kept = big.after(0);
        assert_eq!(kept.pieces.len(), BYTES_MAX / 65_536);
        assert_eq!((kept.lost, kept.more), (24, false));
    }

    #[test]
    fn reading_on_gives_each_piece_once() {
        let tap = WireTap::default();
        let mut seen = Vec::new();
        let mut next = 0;
        for round in 0..5_u8 {
            for n in 0..3 {
                tap.record(Moment::ZERO, IN, &[round * 3 + n]);
            }
            let got = tap.after(next);
            next = got.next;
            seen.extend(got.pieces.into_iter().flat_map(|piece| piece.bytes));
        }
        assert_eq!(seen, (0..15).collect::<Vec<u8>>());
        assert!(tap.after(next).pieces.is_empty());
    }
}
