//! Requests over Modbus RTU (manual 2.4), through tokio-modbus. Replies have neither number nor address, only a length:
//! a length is not requested again while a reply of that length may still come.

use crate::codec::modbus::words_for;
use crate::codec::modbus::words_per_group;
use crate::hand::register::BytePacking;
use crate::hand::{HandId, RegisterWrite, Span};
use crate::link::bus::late_replies::LateReplies;

use crate::link::bus::client::Bus;
use crate::link::bus::error::{BusCounts, BusError, Bytes, lost};
use crate::link::bus::modbus;
use crate::link::bus::packing::{ReadPiece, WordUse};
use crate::link::bus::rtu_line::RtuLine;
use crate::link::clock::Clock;
use crate::link::poll::cost::{WireCost, byte_time, rtu_gap};
use crate::link::poll::window::SHAPES_MAX;
use crate::link::series::PermittedWrite;
use crate::transport::{BoxedWire, Endpoint, Timer, TransportError};
use arrayvec::ArrayVec;
use async_trait::async_trait;
use futures::FutureExt as _;
use std::io;
use std::time::Duration;
use tokio::time::{Instant, timeout};
use tokio_modbus::client::{Client as _, Context, rtu};
use tokio_modbus::{Request, Response, Slave};

/// After a lost reply the line counts as quiet after this long without a byte: longer than any gap inside a frame.
const QUIET: Duration = Duration::from_millis(8);
/// Longest wait for a line that is never quiet.
const SETTLE_MAX: Duration = Duration::from_millis(60);
/// Bytes of a read request, and of a reply frame around its data.
const FRAMING: u32 = 8 + 5;
/// Read lengths for a group of single bytes: three consecutive groups, and some that are still open.
const GROUP_SHAPES: usize = 10;

/// The client side of one RTU line.
pub(crate) struct ModbusRtu {
    context: Context,
    line: RtuLine,
    place: String,
    baud: u32,
    late: LateReplies,
    clock: Clock,
    timer: Timer,
    /// Foreign replies already recorded in `late`.
    strays: u64,
    pub(crate) word_use: WordUse,
}

impl ModbusRtu {
    pub(crate) fn new(
        wire: BoxedWire,
        baud: u32,
        endpoint: &Endpoint,
        late: LateReplies,
        clock: Clock,
    ) -> Self {
        let id = HandId::nearest(endpoint.id_or_unit()).get();
        let line = RtuLine::new(wire, id);
        Self {
            context: rtu::attach_slave(line.clone(), Slave(id)),
            line,
            place: endpoint.place(),
            baud: baud.max(1),
            late,
            clock,
            timer: Timer::default(),
            strays: 0,
            word_use: WordUse::new(endpoint),
        }
    }

    /// Reads six or more raw words: as many as it takes that no late reply can be mistaken for this one.
    async fn group_words(&mut self, address: u16, limit: Duration) -> Result<Vec<u16>, BusError> {
        let least = words_per_group(BytePacking::OnePerWord);
        let shapes: ArrayVec<Span, GROUP_SHAPES> = (least..)
            .map(|count| Span::new(address, 2 * count))
            .take(GROUP_SHAPES)
            .collect();
        let as_seen: ArrayVec<Span, GROUP_SHAPES> = shapes.iter().copied().map(seen).collect();
        let clear = self.late.first_clear(&as_seen, self.clock.now());
        let shape = clear.ok_or(BusError::Ambiguous)?;
        let count = shape.len / 2;
        let request = modbus::words_request(address, count);
        modbus::words_response(count, self.send_read(request, shape, limit).await?)
    }

    /// Sends one read, and records its unanswered state.
    async fn send_read(
        &mut self,
        request: Request<'_>,
        span: Span,
        limit: Duration,
    ) -> Result<Response, BusError> {
        let called = self.call(request, limit).await;
        let now = self.clock.now();
        match &called {
            Ok(_) => self.late.answered(Some(seen(span))),
            // The refusal may be a late one, with the reply still to come.
            Err(_) => self.late.gave_up(seen(span), now),
        }
        self.note_strays();
        called
    }

    async fn call(&mut self, request: Request<'_>, limit: Duration) -> Result<Response, BusError> {
        self.line.abandon();
        self.drain_received()?;
        self.line.flush_pending();
        self.note_strays();
        let called = {
            let mut call = self.context.call(request);
            match timeout(limit, &mut call).await {
                Ok(called) => Some(called),
                Err(_) => {
                    // Noise that resembles the head of a long reply may hide the right one.
                    self.line.flush_pending();
                    call.now_or_never()
                }
            }
        };
        let Some(called) = called else {
            self.line.abandon();
            return Err(BusError::Timeout { after: limit });
        };
        modbus::outcome(called, &self.place, self.line.closed())
    }

    /// Consumes received data without waiting: none of it can answer the next request.
    fn drain_received(&mut self) -> Result<(), BusError> {
        while let Some(received) = self.line.receive().now_or_never() {
            received.map_err(|error| self.lost(&error))?;
        }
        Ok(())
    }

    /// Records stray replies. A stray may belong to any request of its length, or be a duplicate, so it closes none.
    fn note_strays(&mut self) {
        let foreign = self.line.foreign();
        if foreign > self.strays {
            self.strays = foreign;
            self.late.strayed(self.clock.now());
        }
    }

    fn lost(&self, error: &io::Error) -> BusError {
        if self.line.closed() {
            let place = self.place.clone();
            return BusError::Lost(TransportError::HungUp { place });
        }
        lost(&self.place, error)
    }
}

#[async_trait]
impl Bus for ModbusRtu {
    fn has_words(&self) -> bool {
        true
    }

    fn set_packing(&mut self, found: Option<BytePacking>) {
        self.word_use.found = found;
    }

    async fn words(&mut self, address: u16, limit: Duration) -> Result<Option<Vec<u16>>, BusError> {
        self.group_words(address, limit).await.map(Some)
    }

    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let mut bytes = Bytes::new();
        for (nth, piece) in self.word_use.pieces(span).into_iter().enumerate() {
            if nth > 0 {
                self.turn().await?;
            }
            match piece {
                ReadPiece::Memory(part) => {
                    let response = self
                        .send_read(modbus::read_request(part)?, part, limit)
                        .await?;
                    let packing = self.word_use.reading();
                    bytes.extend(modbus::read_response(part, &response, packing)?);
                }
                ReadPiece::Group { group, skip, take } => {
                    let words = self.group_words(group.address, limit).await?;
                    modbus::append_group(&mut bytes, &words, skip, take)?;
                }
            }
        }
        Ok(bytes)
    }

    async fn write(&mut self, write: PermittedWrite<'_>, limit: Duration) -> Result<(), BusError> {
        self.allows(&write)?;
        let response = self.call(modbus::write_request(&write), limit).await?;
        modbus::write_response(&write, &response)?;
        self.late.answered(None);
        self.note_strays();
        Ok(())
    }

    async fn turn(&mut self) -> Result<(), BusError> {
        let end = Instant::now() + SETTLE_MAX;
        loop {
            self.drain_received()?;
            let now = Instant::now();
            let quiet_at = self
                .line
                .last_byte_at()
                .map_or(now, |at| at + rtu_gap(self.baud));
            if quiet_at <= now || now >= end {
                break;
            }
            // The runtime's own timers would extend the silence of 1.75 ms to up to 4.
            self.timer.until(quiet_at).await;
        }
        Ok(())
    }

    async fn quiet(&mut self) -> Result<(), BusError> {
        self.line.abandon();
        let quiet = QUIET.max(rtu_gap(self.baud));
        let end = Instant::now() + SETTLE_MAX;
        while Instant::now() < end {
            match timeout(quiet, self.line.receive()).await {
                Ok(received) => received.map_err(|error| self.lost(&error))?,
                Err(_) => break,
            }
        }
        self.line.flush_pending();
        self.note_strays();
        Ok(())
    }

    fn allows(&self, write: &RegisterWrite) -> Result<(), BusError> {
        self.word_use.allows(write)
    }

    fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        let word_use = self.word_use;
        // Groups with one byte per word choose their length when they are read.
        let fixed = |shape: &Span| {
            let first = word_use.pieces(*shape).into_iter().next();
            match first {
                Some(ReadPiece::Memory(part)) => Some(seen(part)),
                _ => None,
            }
        };
        let as_seen: ArrayVec<Span, SHAPES_MAX> =
            shapes.iter().filter_map(fixed).take(SHAPES_MAX).collect();
        if let Some(free) = shapes.iter().find(|shape| fixed(shape).is_none()) {
            return Some(*free);
        }
        let clear = self.late.first_clear(&as_seen, self.clock.now())?;
        shapes
            .iter()
            .copied()
            .find(|shape| fixed(shape) == Some(clear))
    }

    fn cost(&self) -> WireCost {
        WireCost::rtu(self.baud, rtu_gap(self.baud))
    }

    fn wire_time(&self, bytes: u16) -> Duration {
        byte_time(self.baud) * (u32::from(bytes) + FRAMING) + rtu_gap(self.baud)
    }

    fn counts(&self) -> BusCounts {
        let noise = self.line.noise();
        BusCounts {
            checksum_errors: noise.checksum_errors,
            resyncs: noise.resyncs,
            foreign_replies: self.line.foreign(),
            foreign_requests: self.line.foreign_requests(),
            ..BusCounts::default()
        }
    }

    fn echoes(&self) -> bool {
        self.line.echoes()
    }

    fn own_frames(&self) -> u64 {
        self.line.own_frames()
    }

    fn close(self: Box<Self>) -> LateReplies {
        self.late
    }
}

/// The key by which a reply can be matched: its number of words.
const fn seen(span: Span) -> Span {
    Span::new(0, words_for(span).count.saturating_mul(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::modbus_rtu::crc16;
    use crate::hand::register::STATE;
    use crate::hand::{Angle, HandCommand, PerDof, Target};
    use crate::link::poll::cost::FIXED_GAP;
    use crate::link::series::DeviceSeries;
    use crate::record::WriteCause;
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream};

    const LIMIT: Duration = Duration::from_millis(50);

    fn line() -> (ModbusRtu, DuplexStream) {
        let (near, far) = tokio::io::duplex(4096);
        let endpoint = "rtu:test".parse().unwrap();
        let late = LateReplies::default();
        let mut bus = ModbusRtu::new(Box::new(near), 115_200, &endpoint, late, Clock::start());
        bus.word_use.found = Some(BytePacking::LowFirst);
        (bus, far)
    }

    fn bytes(text: &str) -> Vec<u8> {
        text.split_whitespace()
            .map(|byte| u8::from_str_radix(byte, 16).unwrap())
            .collect()
    }

    /// A reply to a read of this many bytes, all equal.
    fn reply(len: u8, fill: u8) -> Vec<u8> {
        let mut reply = vec![1, 3, len];
        reply.resize(3 + usize::from(len), fill);
        let check = crc16(&reply);
        reply.extend(check.to_le_bytes());
        reply
    }

    async fn received(far: &mut DuplexStream) -> Vec<u8> {
        let mut request = [0; 64];
        let len = far.read(&mut request).await.unwrap();
        request[..len].to_vec()
    }

    #[tokio::test(start_paused = true)]
    async fn a_read_is_the_manuals_frame_and_its_words_are_low_byte_first() {
        let (mut bus, mut far) = line();
        // Manual 2.4.1, whose print swaps the bytes of the address that its text names, 0x006B.
        let answer = async {
            assert_eq!(received(&mut far).await, bytes("01 03 00 6B 00 02 B5 D7"));
            far.write_all(&bytes("01 03 04 00 01 00 02 2A 32"))
                .await
                .unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(Span::new(0x6B, 4), LIMIT), answer);
        assert_eq!(read.unwrap().as_slice(), [1, 0, 2, 0]);
    }

    #[tokio::test(start_paused = true)]
    async fn writes_are_functions_6_and_16_and_the_printed_zeros_acknowledge() {
        let (mut bus, mut far) = line();
        let open = HandCommand::Angles(PerDof::splat(Some(Target::Go(Angle::MAX)))).writes();
        let frame = "01 10 05 CE 00 06 0C 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8";
        for (write, asked, answered) in [
            (
                HandCommand::ClearErrors.writes(),
                "01 06 03 EC 00 01",
                "01 06 03 EC 00 01",
            ),
            // Manual 2.4.2 as printed.
            (
                HandCommand::ClearErrors.writes(),
                "01 06 03 EC 00 01",
                "01 06 00 00 00 00",
            ),
            (open, frame, "01 10 05 CE 00 06"),
        ] {
            let checked = |text: &str| {
                let mut body = bytes(text);
                body.extend(crc16(&body).to_le_bytes());
                body
            };
            let answer = async {
                assert_eq!(received(&mut far).await, checked(asked));
                far.write_all(&checked(answered)).await.unwrap();
            };
            let permitted = DeviceSeries::Ours
                .permit(&write[0], WriteCause::Setpoint)
                .unwrap();
            let (written, ()) = tokio::join!(bus.write(permitted, LIMIT), answer);
            assert_eq!(written, Ok(()), "{answered}");
        }
    }

    #[tokio::test(start_paused = true)]
    async fn a_reply_of_another_length_is_dropped_counted_and_no_answer() {
        let (mut bus, mut far) = line();
        far.write_all(&reply(76, 9)).await.unwrap();
        let answer = async {
            received(&mut far).await;
            far.write_all(&reply(76, 9)).await.unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(STATE, LIMIT), answer);
        assert_eq!(read, Err(BusError::Timeout { after: LIMIT }));
        assert_eq!(bus.counts().foreign_replies, 2);
    }

    #[tokio::test(start_paused = true)]
    async fn a_late_reply_never_answers_a_later_request() {
        let (mut bus, mut far) = line();
        let shapes = [STATE, Span::new(STATE.address, 72)];
        assert_eq!(bus.choose(&shapes), Some(STATE));
        assert!(bus.read(STATE, LIMIT).await.is_err());
        bus.quiet().await.unwrap();
        // Another span of the same length would match it too.
        assert_eq!(bus.choose(&[Span::new(1474, STATE.len)]), None);
        let next = bus.choose(&shapes).unwrap();
        assert_eq!(next.len, 72);
        let answer = async {
            received(&mut far).await;
            far.write_all(&reply(78, 1)).await.unwrap();
            far.write_all(&reply(72, 2)).await.unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(next, LIMIT), answer);
        assert_eq!(read.unwrap().as_slice(), [2; 72]);
        assert_eq!(bus.choose(&shapes), None, "78 stays open, 72 was just read");
    }

    #[tokio::test(start_paused = true)]
    async fn a_wrong_check_is_counted_and_the_next_exchange_is_undisturbed() {
        let (mut bus, mut far) = line();
        let mut bad = reply(78, 1);
        bad[20] ^= 4;
        let answer = async {
            received(&mut far).await;
            far.write_all(&bad).await.unwrap();
            far.write_all(&reply(78, 1)[..30]).await.unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(STATE, LIMIT), answer);
        assert!(read.is_err());
        bus.quiet().await.unwrap();
        assert_eq!(bus.counts().checksum_errors, 1);
        let answer = async {
            received(&mut far).await;
            far.write_all(&reply(72, 3)).await.unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(Span::new(1546, 72), LIMIT), answer);
        assert_eq!(read.unwrap().as_slice(), [3; 72]);
    }

    #[tokio::test(start_paused = true)]
    async fn a_reply_behind_the_head_of_a_longer_one_is_found_at_the_end() {
        let (mut bus, mut far) = line();
        let answer = async {
            received(&mut far).await;
            far.write_all(&[1, 3, 250]).await.unwrap();
            far.write_all(&reply(78, 5)).await.unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(STATE, LIMIT), answer);
        assert_eq!(read.unwrap().as_slice(), [5; 78]);
    }

    #[tokio::test(start_paused = true)]
    async fn a_refusal_and_a_hang_up_have_their_own_errors() {
        let (mut bus, mut far) = line();
        let answer = async {
            received(&mut far).await;
            far.write_all(&bytes("01 83 02 C0 F1")).await.unwrap();
        };
        let (read, ()) = tokio::join!(bus.read(STATE, LIMIT), answer);
        assert!(matches!(read, Err(BusError::Refused { .. })), "{read:?}");
        drop(far);
        let read = bus.read(STATE, LIMIT).await;
        let place = "test".into();
        assert_eq!(read, Err(BusError::Lost(TransportError::HungUp { place })));
    }

    #[tokio::test(start_paused = true)]
    async fn frames_are_three_and_a_half_characters_apart() {
        assert_eq!(rtu_gap(9600), Duration::from_nanos(3_645_831));
        assert_eq!(rtu_gap(115_200), FIXED_GAP);
        let (mut bus, mut far) = line();
        far.write_all(&[0]).await.unwrap();
        let before = Instant::now();
        bus.turn().await.unwrap();
        assert!(before.elapsed() >= FIXED_GAP);
        let before = Instant::now();
        bus.turn().await.unwrap();
        assert_eq!(before.elapsed(), Duration::ZERO, "the line is quiet");
    }
}
