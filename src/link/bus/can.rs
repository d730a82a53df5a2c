//! Requests over CAN (manual 2.3): ranges of memory in pieces of at most 8 bytes, each with its own request and reply.
//!
//! Request and reply share one identifier and have no number. A reply is distinguished from a late one by address and
//! length, and a piece that a late reply could answer is read in two smaller ones. Remaining ambiguity: a one-byte
//! piece requested by another program on the same bus at the same time looks like the hand's reply, and a late
//! acknowledgement looks like that of the same write sent again. Nothing is planned or retried here.

use crate::codec::can::{
    CanData, CanFrame, CanFunction, CanId, ReadPieces, may_cut, read_request, split, write_requests,
};
use crate::hand::{Span, register};
use crate::link::bus::can_port::CanPort;
use crate::link::bus::client::{Bus, Urgent};
use crate::link::bus::error::{BusCounts, BusError, Bytes, READ_MAX};
use crate::link::bus::late_replies::LateReplies;
use crate::link::clock::Clock;
use crate::link::poll::cost::{WireCost, packets_time};
use crate::link::series::PermittedWrite;
use crate::transport::endpoint::DEFAULT_BITRATE;
use crate::transport::{BoxedWire, Endpoint};
use arrayvec::ArrayVec;
use async_trait::async_trait;
use futures::FutureExt as _;
use std::time::Duration;
use tokio::time::{Instant, timeout, timeout_at};

/// The bus counts as quiet after this long without a frame for us.
const QUIET: Duration = Duration::from_millis(8);
/// Longest wait for a bus that is never quiet.
const SETTLE_MAX: Duration = Duration::from_millis(60);
/// Longest wait for one piece: a hand takes up to 30 ms, a USB adapter twice 16 more.
const PIECE_LIMIT: Duration = Duration::from_millis(80);
/// Assumed time of one piece: a request and a reply at 500 kbit/s and the hand's own time …
const PIECE_TIME: Duration = Duration::from_millis(3);
/// … and through a USB adapter with a latency of up to 16 ms.
const ADAPTER_PIECE_TIME: Duration = Duration::from_millis(18);
/// Data bytes of the reply to a write (manual 2.3.2).
const ACK_LEN: usize = 1;
/// Consecutive requests without a reply after which the controller's bus state counts as the cause.
const UNANSWERED_MAX: u32 = 2;
/// Requests kept: more than an adapter that echoes can hold back.
const SENT_MAX: usize = 8;
/// First read, to detect an adapter that echoes: two bytes, so that request and reply differ in length.
const PROBE: Span = Span::new(register::ANGLE_ACT.address, 2);

/// The client side of one CAN bus.
pub(crate) struct Can {
    port: CanPort,
    hand: u16,
    cost: WireCost,
    /// Assumed time of one piece.
    piece_time: Duration,
    is_open: bool,
    /// True if our frames are echoed; `None` until known.
    echoes: Option<bool>,
    late: LateReplies,
    clock: Clock,
    unanswered: u32,
    foreign: u64,
    /// The last requests, oldest first: an equal frame is not foreign.
    sent: ArrayVec<CanFrame, SENT_MAX>,
    foreign_requests: u64,
}

impl Can {
    pub(crate) fn new(
        wire: BoxedWire,
        endpoint: &Endpoint,
        late: LateReplies,
        clock: Clock,
    ) -> Self {
        let port = CanPort::new(wire, endpoint);
        Self {
            hand: endpoint.id_or_unit(),
            cost: WireCost::of(endpoint).unwrap_or(WireCost::can(DEFAULT_BITRATE)),
            piece_time: match endpoint {
                Endpoint::Slcan { .. } => ADAPTER_PIECE_TIME,
                Endpoint::UsbCan { baud, .. } => ADAPTER_PIECE_TIME + packets_time(*baud),
                _ => PIECE_TIME,
            },
            is_open: false,
            echoes: port.never_echoes().then_some(false),
            port,
            late,
            clock,
            unanswered: 0,
            foreign: 0,
            sent: ArrayVec::new(),
            foreign_requests: 0,
        }
    }

    async fn read_piece(&mut self, piece: Span, limit: Duration) -> Result<CanData, BusError> {
        let request = read_request(self.hand, piece).ok_or(BusError::TooLong)?;
        let got = self.exchange(&request, usize::from(piece.len), limit).await;
        match &got {
            Ok(_) => self.late.answered(Some(piece)),
            Err(_) => self.late.gave_up(piece, self.clock.now()),
        }
        got
    }

    /// Opens the bus, and detects echoes before the first request that resembles its reply.
    async fn open(&mut self, limit: Duration) -> Result<(), BusError> {
        if !self.is_open {
            self.port.open().await?;
            self.is_open = true;
        }
        if self.echoes.is_none() {
            self.read_piece(PROBE, limit).await?;
            self.echoes.get_or_insert(false);
        }
        Ok(())
    }

    fn is_clear(&mut self, piece: Span) -> bool {
        self.late.first_clear(&[piece], self.clock.now()).is_some()
    }

    /// The pieces of a range that no late reply can answer; `None` if there is no such split.
    fn clear_pieces(&mut self, span: Span) -> Option<ReadPieces> {
        let mut clear = ReadPieces::new();
        for piece in split(span)? {
            if self.is_clear(piece) {
                clear.try_push(piece).ok()?;
                continue;
            }
            let mut lens = (1..piece.len).rev();
            let (first, second) = lens.find_map(|len| {
                let first = Span::new(piece.address, len);
                let second = Span::new(piece.address + len, piece.len - len);
                let clear = may_cut(second.address) && self.is_clear(first);
                (clear && self.is_clear(second)).then_some((first, second))
            })?;
            clear.try_push(first).ok()?;
            clear.try_push(second).ok()?;
        }
        Some(clear)
    }

    /// Sends one request and waits for a reply of `want` data bytes. Each piece gets the whole limit: a slow hand is
    /// slow for each of its forty pieces.
    async fn exchange(
        &mut self,
        request: &CanFrame,
        want: usize,
        limit: Duration,
    ) -> Result<CanData, BusError> {
        self.drain_received()?;
        if self.sent.is_full() {
            self.sent.remove(0);
        }
        self.sent.push(request.clone());
        let limit = limit.min(PIECE_LIMIT);
        let deadline = Instant::now() + limit;
        match timeout_at(deadline, self.port.send(request)).await {
            Ok(sent) => sent?,
            Err(_) => return Err(self.no_reply(limit)),
        }
        // Only if the reply may look like the request; otherwise the length distinguishes them.
        let mut echo_due = self.echoes == Some(true) && request.data.len() == want;
        loop {
            while let Some(frame) = self.port.next() {
                if frame == *request && echo_due {
                    echo_due = false;
                } else if frame.id == request.id && frame.data.len() == want {
                    self.unanswered = 0;
                    self.port.forget_refusals();
                    return Ok(frame.data);
                } else if frame == *request && !self.port.never_echoes() {
                    self.echoes = Some(true);
                } else {
                    self.foreign_frame(&frame);
                }
            }
            match timeout_at(deadline, self.port.receive()).await {
                Ok(received) => received?,
                Err(_) => return Err(self.no_reply(limit)),
            }
        }
    }

    fn no_reply(&mut self, after: Duration) -> BusError {
        self.unanswered += 1;
        match self.port.trouble() {
            Some(trouble) if self.unanswered >= UNANSWERED_MAX => BusError::Lost(trouble),
            _ => BusError::Timeout { after },
        }
    }

    /// Consumes received frames without waiting: none of them can answer the next request.
    fn drain_received(&mut self) -> Result<(), BusError> {
        while let Some(received) = self.port.receive().now_or_never() {
            received?;
            self.drop_foreign();
        }
        self.drop_foreign();
        Ok(())
    }

    fn drop_foreign(&mut self) {
        while let Some(frame) = self.port.next() {
            self.foreign_frame(&frame);
        }
    }

    /// Returns whether a frame is a request. Requests and replies share an identifier: a write of two bytes or more is
    /// a request, because its acknowledgement has one; a single byte of a read is a request, unless we requested a
    /// single byte there ourselves.
    fn is_request(&self, id: CanId, frame: &CanFrame) -> bool {
        match id.way {
            CanFunction::Write => frame.data.len() > ACK_LEN,
            CanFunction::Read => {
                let asked_here =
                    |sent: &CanFrame| sent.id == frame.id && sent.data.as_slice() == [1];
                frame.data.len() == 1 && !self.sent.iter().any(asked_here)
            }
        }
    }

    /// Counts a frame that answers no request of ours. Frames of other hands are ignored.
    fn foreign_frame(&mut self, frame: &CanFrame) {
        let Some(id) = CanId::from_raw(frame.id).filter(|id| id.hand == self.hand) else {
            return;
        };
        if self.is_request(id, frame) {
            // An adapter may have been judged not to echo because the first echo was lost.
            let echo = !self.port.never_echoes() && self.sent.contains(frame);
            self.foreign_requests += u64::from(!echo);
            return;
        }
        self.foreign += 1;
        if id.way == CanFunction::Read
            && let Ok(len) = u16::try_from(frame.data.len())
        {
            self.late
                .arrived(Span::new(id.address, len), self.clock.now());
        }
    }
}

#[async_trait]
impl Bus for Can {
    async fn write(&mut self, write: PermittedWrite<'_>, limit: Duration) -> Result<(), BusError> {
        self.write_unless(write, limit, &|| false).await
    }

    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let read = self.read_unless(span, limit, &|| false).await?;
        Ok(read.unwrap_or_default())
    }

    async fn read_unless(
        &mut self,
        span: Span,
        limit: Duration,
        urgent: Urgent<'_>,
    ) -> Result<Option<Bytes>, BusError> {
        if usize::from(span.len) > READ_MAX {
            return Err(BusError::TooLong);
        }
        let whole = split(span).ok_or(BusError::TooLong)?;
        self.open(limit).await?;
        // The first read of a hand has no other form.
        let pieces = self.clear_pieces(span).unwrap_or(whole);
        let mut bytes = Bytes::new();
        for piece in pieces {
            if urgent() {
                return Ok(None);
            }
            let got = self.read_piece(piece, limit).await?;
            // No piece is longer than requested, and the range fits.
            bytes.extend(got);
        }
        Ok(Some(bytes))
    }

    async fn write_unless(
        &mut self,
        write: PermittedWrite<'_>,
        limit: Duration,
        urgent: Urgent<'_>,
    ) -> Result<(), BusError> {
        let requests = write_requests(self.hand, &write).ok_or(BusError::TooLong)?;
        self.open(limit).await?;
        for (nth, request) in requests.iter().enumerate() {
            if nth > 0 && urgent() {
                break;
            }
            self.exchange(request, ACK_LEN, limit).await?;
            self.late.answered(None);
        }
        Ok(())
    }

    async fn quiet(&mut self) -> Result<(), BusError> {
        let end = Instant::now() + SETTLE_MAX;
        while Instant::now() < end {
            match timeout(QUIET, self.port.receive()).await {
                Ok(received) => received?,
                Err(_) => break,
            }
            self.drop_foreign();
        }
        Ok(())
    }

    fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        let whole = shapes.iter().copied().find(|shape| {
            split(*shape).is_some_and(|pieces| pieces.iter().all(|piece| self.is_clear(*piece)))
        });
        whole.or_else(|| {
            let mut shapes = shapes.iter().copied();
            shapes.find(|shape| self.clear_pieces(*shape).is_some())
        })
    }

    fn cost(&self) -> WireCost {
        self.cost
    }

    fn wire_time(&self, bytes: u16) -> Duration {
        self.piece_time * (u32::from(bytes).div_ceil(8) + 1)
    }

    fn counts(&self) -> BusCounts {
        let noise = self.port.noise();
        BusCounts {
            checksum_errors: noise.checksum_errors,
            resyncs: noise.resyncs,
            foreign_replies: self.foreign,
            foreign_requests: self.foreign_requests,
            ..BusCounts::default()
        }
    }

    fn echoes(&self) -> bool {
        self.echoes == Some(true)
    }

    fn close(mut self: Box<Self>) -> LateReplies {
        self.port.close();
        self.late
    }
}
