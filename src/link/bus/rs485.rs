//! Requests over the private RS485 framing (manual 2.2). One is open at a time; replies have no number.

use crate::codec::rs485::{
    ReplyDecoder, Rs485Frame, Rs485Reply, SaveResult, encode_read, encode_write,
};
use crate::hand::register::HAND_ID;
use crate::hand::{HandId, Span};
use crate::link::bus::echo::Echo;
use crate::link::bus::late_replies::LateReplies;

use crate::link::bus::client::{Bus, ResultFrame};
use crate::link::bus::error::{BusCounts, BusError, Bytes, lost};
use crate::link::clock::Clock;
use crate::link::poll::cost::WireCost;
use crate::link::series::PermittedWrite;
use crate::transport::{BoxedWire, Endpoint, TransportError};
use arrayvec::ArrayVec;
use async_trait::async_trait;
use futures::FutureExt as _;
use std::io;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Instant, timeout, timeout_at};

/// The line counts as quiet after this long without a byte: longer than any gap inside a frame.
const QUIET: Duration = Duration::from_millis(8);
/// Longest wait for a line that is never quiet.
const SETTLE_MAX: Duration = Duration::from_millis(60);
/// Maximum bytes per read from the wire: the longest reply and some noise.
const CHUNK: usize = 512;
/// Bits of a byte on the line: start, eight, stop.
const BITS: u64 = 10;
/// Bytes of a read request and of a reply frame around its data.
const FRAMING: u64 = 9 + 8;
/// Maximum SAVE results kept until they are read: one, its duplicate, and one more.
const RESULTS_MAX: usize = 3;

/// The client side of one RS485 line.
pub(crate) struct Rs485 {
    wire: BoxedWire,
    place: String,
    id: HandId,
    baud: Option<u32>,
    decoder: ReplyDecoder,
    late: LateReplies,
    clock: Clock,
    foreign: u64,
    /// The last request: an equal frame is its echo.
    sent: Rs485Frame,
    echo: Echo,
    own_frames: u64,
    foreign_requests: u64,
    save_results: ArrayVec<SaveResult, RESULTS_MAX>,
    is_calibrated: bool,
}

/// Reply that an open request expects.
enum ExpectedReply {
    Bytes(Span),
    /// Acknowledgement of a write to this address. Manual: silent on who acknowledges a change of HAND_ID; the older
    /// manual shows the new id (protocol choice 9).
    Ack {
        address: u16,
        new_id: Option<u8>,
    },
}

/// Match of a reply with the open request.
#[expect(
    clippy::large_enum_variant,
    reason = "it lives on the stack, for one exchange"
)]
enum ReplyMatch {
    Bytes(Bytes),
    Ack,
    No,
}

impl Rs485 {
    pub(crate) fn new(
        wire: BoxedWire,
        endpoint: &Endpoint,
        late: LateReplies,
        clock: Clock,
    ) -> Self {
        let baud = match endpoint {
            Endpoint::Rs485(line) => Some(line.baud),
            _ => None,
        };
        Self {
            wire,
            place: endpoint.place(),
            id: HandId::nearest(endpoint.id_or_unit()),
            baud,
            decoder: ReplyDecoder::default(),
            late,
            clock,
            foreign: 0,
            sent: Rs485Frame::new(),
            echo: Echo::default(),
            own_frames: 0,
            foreign_requests: 0,
            save_results: ArrayVec::new(),
            is_calibrated: false,
        }
    }

    async fn exchange(
        &mut self,
        frame: &Rs485Frame,
        expected: &ExpectedReply,
        limit: Duration,
    ) -> Result<ReplyMatch, BusError> {
        self.drain_received()?;
        self.sent.clone_from(frame);
        self.echo.sent();
        let deadline = Instant::now() + limit;
        let timed_out = BusError::Timeout { after: limit };
        match timeout_at(deadline, self.wire.write_all(frame)).await {
            Ok(written) => written.map_err(|error| self.lost(&error))?,
            Err(_) => return Err(timed_out),
        }
        loop {
            if let Some(fit) = self.fitting(expected) {
                return Ok(fit);
            }
            match timeout_at(deadline, self.receive()).await {
                Ok(received) => received?,
                Err(_) => break,
            }
        }
        // Noise that resembles the head of a long frame may hide the reply.
        self.decoder.flush_pending();
        self.fitting(expected).ok_or(timed_out)
    }

    /// Consumes received data without waiting: none of it can answer the next request.
    fn drain_received(&mut self) -> Result<(), BusError> {
        while let Some(received) = self.receive().now_or_never() {
            received?;
            self.drop_foreign();
        }
        self.decoder.flush_pending();
        self.drop_foreign();
        Ok(())
    }

    fn drop_foreign(&mut self) {
        while let Some(reply) = self.decoder.next() {
            self.foreign_reply(&reply);
        }
        self.sort_overheard();
    }

    /// Sorts overheard requests: echoes of our own, or another controller's.
    fn sort_overheard(&mut self) {
        while let Some(request) = self.decoder.overheard() {
            if request == self.sent {
                self.own_frames += 1;
                self.echo.came_back();
            } else {
                self.foreign_requests += 1;
            }
        }
    }

    /// The reply to the open request, if received; others are counted and dropped.
    fn fitting(&mut self, expected: &ExpectedReply) -> Option<ReplyMatch> {
        while let Some(reply) = self.decoder.next() {
            self.sort_overheard();
            match self.fit(&reply, expected) {
                ReplyMatch::No => self.unfit_reply(&reply, expected),
                fit => {
                    self.echo.answered();
                    return Some(fit);
                }
            }
        }
        self.sort_overheard();
        None
    }

    fn fit(&self, reply: &Rs485Reply, expected: &ExpectedReply) -> ReplyMatch {
        match (reply, expected) {
            (Rs485Reply::Read { id, address, bytes }, ExpectedReply::Bytes(span))
                if *id == self.id.get()
                    && *address == span.address
                    && bytes.len() == usize::from(span.len) =>
            {
                ReplyMatch::Bytes(bytes.clone())
            }
            (
                Rs485Reply::WriteAck {
                    id,
                    address,
                    value: 1,
                },
                ExpectedReply::Ack {
                    address: wanted,
                    new_id,
                },
            ) if (*id == self.id.get() || Some(*id) == *new_id) && address == wanted => {
                ReplyMatch::Ack
            }
            _ => ReplyMatch::No,
        }
    }

    /// Counts a reply that does not answer the open request.
    fn unfit_reply(&mut self, reply: &Rs485Reply, expected: &ExpectedReply) {
        // Manual: 1 acknowledges. Another value in its place is no flash result, though a result looks the same,
        // because a result follows the acknowledgement.
        match (reply, expected) {
            (Rs485Reply::WriteAck { address, .. }, ExpectedReply::Ack { address: own, .. })
                if address == own =>
            {
                self.foreign += 1;
            }
            _ => self.foreign_reply(reply),
        }
    }

    /// Counts a reply that answers no request of ours. The result of a save or of a calibration is none: the hand sends it by itself.
    fn foreign_reply(&mut self, reply: &Rs485Reply) {
        if reply.id() == self.id.get() {
            if let Some(result) = reply.save_result() {
                // The oldest results suffice.
                let _more = self.save_results.try_push(result);
                return;
            }
            if reply.is_calibration_end() {
                self.is_calibrated = true;
                return;
            }
        }
        self.foreign += 1;
        if let Rs485Reply::Read { address, bytes, .. } = reply
            && let Ok(len) = u16::try_from(bytes.len())
        {
            self.late
                .arrived(Span::new(*address, len), self.clock.now());
        }
    }

    /// Waits for bytes and passes them to the decoder. Safe to cancel: no bytes are lost.
    async fn receive(&mut self) -> Result<(), BusError> {
        let mut chunk = [0; CHUNK];
        let room = CHUNK.saturating_sub(self.decoder.buffered()).max(1);
        let into = chunk.get_mut(..room).unwrap_or_default();
        let got = self
            .wire
            .read(into)
            .await
            .map_err(|error| self.lost(&error))?;
        if got == 0 {
            return Err(BusError::Lost(TransportError::HungUp {
                place: self.place.clone(),
            }));
        }
        let bytes = into.get(..got).unwrap_or_default();
        let taken = self.decoder.push(bytes);
        debug_assert_eq!(taken, got, "the decoder has room for what was asked for");
        Ok(())
    }

    fn lost(&self, error: &io::Error) -> BusError {
        lost(&self.place, error)
    }
}

#[async_trait]
impl Bus for Rs485 {
    fn save_result_frame(&self) -> ResultFrame {
        ResultFrame::Comes
    }

    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let frame = encode_read(self.id, span).ok_or(BusError::TooLong)?;
        let result = self
            .exchange(&frame, &ExpectedReply::Bytes(span), limit)
            .await;
        match result {
            Ok(_) => self.late.answered(Some(span)),
            Err(_) => self.late.gave_up(span, self.clock.now()),
        }
        match result? {
            ReplyMatch::Bytes(bytes) => Ok(bytes),
            ReplyMatch::Ack | ReplyMatch::No => Err(BusError::WrongLength {
                got: 0,
                want: usize::from(span.len),
            }),
        }
    }

    async fn write(&mut self, write: PermittedWrite<'_>, limit: Duration) -> Result<(), BusError> {
        let frame = encode_write(self.id, &write);
        let address = write.address();
        let is_id = address == HAND_ID.address;
        let new_id = write.bytes().first().copied().filter(|_| is_id);
        self.exchange(&frame, &ExpectedReply::Ack { address, new_id }, limit)
            .await?;
        self.late.answered(None);
        Ok(())
    }

    async fn quiet(&mut self) -> Result<(), BusError> {
        let end = Instant::now() + SETTLE_MAX;
        while Instant::now() < end {
            match timeout(QUIET, self.receive()).await {
                Ok(received) => received?,
                Err(_) => break,
            }
            self.drop_foreign();
        }
        self.decoder.flush_pending();
        self.drop_foreign();
        Ok(())
    }

    fn take_save_result(&mut self) -> Option<SaveResult> {
        self.save_results.pop_at(0)
    }

    fn take_calibration_end(&mut self) -> bool {
        std::mem::replace(&mut self.is_calibrated, false)
    }

    async fn listen(&mut self) -> Result<(), BusError> {
        while self.save_results.is_empty() && !self.is_calibrated {
            self.receive().await?;
            self.drop_foreign();
        }
        Ok(())
    }

    fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        self.late.first_clear(shapes, self.clock.now())
    }

    fn cost(&self) -> WireCost {
        WireCost::rs485(self.baud)
    }

    fn wire_time(&self, bytes: u16) -> Duration {
        let bits = (u64::from(bytes) + FRAMING) * BITS;
        self.baud.map_or(Duration::ZERO, |baud| {
            Duration::from_micros(bits * 1_000_000 / u64::from(baud.max(1)))
        })
    }

    fn counts(&self) -> BusCounts {
        let noise = self.decoder.counts();
        BusCounts {
            checksum_errors: noise.checksum_errors,
            resyncs: noise.resyncs,
            foreign_replies: self.foreign,
            foreign_requests: self.foreign_requests,
            ..BusCounts::default()
        }
    }

    fn echoes(&self) -> bool {
        self.echo.is_sure()
    }

    fn own_frames(&self) -> u64 {
        self.own_frames
    }

    fn close(self: Box<Self>) -> LateReplies {
        self.late
    }
}
