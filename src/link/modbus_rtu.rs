//! Requests over Modbus RTU (manual 2.4), through tokio-modbus. Replies have neither number nor address, only a length:
//! no length is asked for again while a reply of that length may still come.

use crate::codec::modbus::words_for;
use crate::hand::{HandId, RegisterWrite, Span};
use crate::link::bus::{BusCounts, BusError, Bytes, id_of, lost};
use crate::link::clock::Clock;
use crate::link::late::LateReplies;
use crate::link::modbus;
use crate::link::rtu_line::RtuLine;
use crate::transport::{BoxedWire, Endpoint, TransportError};
use arrayvec::ArrayVec;
use futures::FutureExt as _;
use std::io;
use std::time::Duration;
use tokio::time::{Instant, sleep_until, timeout};
use tokio_modbus::client::{Client as _, Context, rtu};
use tokio_modbus::{Request, Response, Slave};

/// After a lost reply the line counts as quiet after this long without a byte: longer than any gap inside a frame.
const QUIET: Duration = Duration::from_millis(8);
/// A line that is never quiet is not waited for longer than this.
const SETTLE_MAX: Duration = Duration::from_millis(60);
/// Bits of a byte on the line: start, eight, stop.
const BITS: u64 = 10;
/// Bytes of a read request, and of a reply's frame around its data.
const FRAMING: u64 = 8 + 5;
/// Above this baud the silence between frames does not shrink any more (Modbus over serial line 1.02, 2.5.1.1).
const FIXED_GAP_ABOVE: u32 = 19_200;
const FIXED_GAP: Duration = Duration::from_micros(1750);
/// Most shapes that one group is asked in.
const SHAPES_MAX: usize = 16;

/// The client side of one RTU line.
pub(crate) struct ModbusRtu {
    context: Context,
    line: RtuLine,
    place: String,
    baud: u32,
    late: LateReplies,
    clock: Clock,
    /// Foreign replies that `late` knows of.
    strays: u64,
}

impl ModbusRtu {
    pub(crate) fn new(
        wire: BoxedWire,
        baud: u32,
        endpoint: &Endpoint,
        late: LateReplies,
        clock: Clock,
    ) -> Self {
        let id = HandId::nearest(id_of(endpoint)).get();
        let line = RtuLine::new(wire, id);
        Self {
            context: rtu::attach_slave(line.clone(), Slave(id)),
            line,
            place: endpoint.to_string(),
            baud: baud.max(1),
            late,
            clock,
            strays: 0,
        }
    }

    pub(crate) async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let called = self.call(modbus::read_request(span)?, limit).await;
        let now = self.clock.now();
        match &called {
            Ok(_) => self.late.answered(Some(seen(span))),
            // A refusal may have been late itself, with the reply still to come.
            Err(_) => self.late.gave_up(seen(span), now),
        }
        self.note_strays();
        modbus::read_response(span, &called?)
    }

    pub(crate) async fn write(
        &mut self,
        write: &RegisterWrite,
        limit: Duration,
    ) -> Result<(), BusError> {
        let response = self.call(modbus::write_request(write), limit).await?;
        modbus::write_response(write, &response)?;
        self.late.answered(None);
        self.note_strays();
        Ok(())
    }

    /// Listens until the line is quiet.
    pub(crate) async fn settle(&mut self) -> Result<(), BusError> {
        self.line.abandon();
        let quiet = QUIET.max(gap(self.baud));
        let end = Instant::now() + SETTLE_MAX;
        while Instant::now() < end {
            match timeout(quiet, self.line.hear()).await {
                Ok(heard) => heard.map_err(|error| self.lost(&error))?,
                Err(_) => break,
            }
        }
        self.line.flush_pending();
        self.note_strays();
        Ok(())
    }

    pub(crate) fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        let as_seen: ArrayVec<Span, SHAPES_MAX> =
            shapes.iter().copied().map(seen).take(SHAPES_MAX).collect();
        let clear = self.late.first_clear(&as_seen, self.clock.now())?;
        shapes.iter().copied().find(|shape| seen(*shape) == clear)
    }

    pub(crate) fn wire_time(&self, bytes: u16) -> Duration {
        line_time(u64::from(bytes) + FRAMING, self.baud) + gap(self.baud)
    }

    pub(crate) fn counts(&self) -> BusCounts {
        let noise = self.line.noise();
        BusCounts {
            checksum_errors: noise.checksum_errors,
            resyncs: noise.resyncs,
            foreign_replies: self.line.foreign(),
        }
    }

    pub(crate) fn close(self) -> LateReplies {
        self.late
    }

    async fn call(&mut self, request: Request<'_>, limit: Duration) -> Result<Response, BusError> {
        self.line.abandon();
        self.wait_for_gap().await?;
        let called = {
            let mut call = self.context.call(request);
            match timeout(limit, &mut call).await {
                Ok(called) => Some(called),
                Err(_) => {
                    // Noise that looks like the head of a long reply may hide the right one.
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

    /// Takes what came while nobody asked, and leaves the silence that separates frames. A line that babbles on is
    /// talked over at last.
    async fn wait_for_gap(&mut self) -> Result<(), BusError> {
        let end = Instant::now() + SETTLE_MAX;
        loop {
            while let Some(heard) = self.line.hear().now_or_never() {
                heard.map_err(|error| self.lost(&error))?;
            }
            let now = Instant::now();
            let quiet_at = self.line.heard().map_or(now, |at| at + gap(self.baud));
            if quiet_at <= now || now >= end {
                break;
            }
            sleep_until(quiet_at).await;
        }
        self.line.flush_pending();
        self.note_strays();
        Ok(())
    }

    /// A stray reply may belong to any question of its length, or be a double: none is closed by it.
    fn note_strays(&mut self) {
        let foreign = self.line.foreign();
        if foreign > self.strays {
            self.strays = foreign;
            self.late.strayed(self.clock.now());
        }
    }

    fn lost(&self, error: &io::Error) -> BusError {
        let place = self.place.clone();
        BusError::Lost(if self.line.closed() {
            TransportError::HungUp { place }
        } else {
            lost(place, error)
        })
    }
}

/// All that a reply tells about the span it answers: how many words it has.
const fn seen(span: Span) -> Span {
    Span::new(0, words_for(span).count.saturating_mul(2))
}

fn line_time(bytes: u64, baud: u32) -> Duration {
    Duration::from_micros(bytes * BITS * 1_000_000 / u64::from(baud))
}

/// Silence between frames: 3.5 characters.
fn gap(baud: u32) -> Duration {
    if baud > FIXED_GAP_ABOVE {
        FIXED_GAP
    } else {
        line_time(7, baud) / 2
    }
}
