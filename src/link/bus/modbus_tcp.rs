//! Requests over Modbus TCP (manual 2.5), through tokio-modbus. Replies carry a number, which the filter checks.

use crate::codec::modbus::words_per_group;
use crate::hand::register::BytePacking;
use crate::hand::{RegisterWrite, Span};
use crate::link::bus::client::{Bus, Urgent};
use crate::link::bus::error::{BusCounts, BusError, Bytes};
use crate::link::bus::filter::{FilterCounts, ReplyFilter};
use crate::link::bus::late_replies::{LateReply, REPLY_LIMIT_MIN, slow_limit};
use crate::link::bus::modbus;
use crate::link::bus::packing::{ReadPiece, WordUse};
use crate::link::poll::cost::WireCost;
use crate::link::series::PermittedWrite;
use crate::transport::{BoxedWire, Endpoint};
use async_trait::async_trait;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use tokio::time::{Instant, timeout_at};
use tokio_modbus::client::{Client as _, Context, tcp};
use tokio_modbus::{Request, Response, Slave};

/// Interval at which a stop is checked for while a reply is late.
const URGENT_INTERVAL: Duration = Duration::from_millis(5);

/// The client side of one Modbus TCP connection.
pub(crate) struct ModbusTcp {
    context: Context,
    counts: Arc<FilterCounts>,
    place: String,
    pub(crate) word_use: WordUse,
}

impl ModbusTcp {
    pub(crate) fn new(wire: BoxedWire, unit: u8, endpoint: &Endpoint) -> Self {
        let counts = Arc::new(FilterCounts::default());
        let filter = ReplyFilter::new(wire, Arc::clone(&counts));
        Self {
            context: tcp::attach_slave(filter, Slave(unit)),
            counts,
            place: endpoint.place(),
            word_use: WordUse::new(endpoint),
        }
    }

    /// Reads raw words, to detect the byte packing.
    async fn group_words(
        &mut self,
        address: u16,
        count: u16,
        limit: Duration,
    ) -> Result<Vec<u16>, BusError> {
        let request = modbus::words_request(address, count);
        modbus::words_response(count, self.call(request, limit, &|| false).await?)
    }

    /// Sends one request. A late reply to an earlier one extends the wait. Once the reply is late itself, an urgent
    /// event ends the wait: the request number identifies a reply that still comes.
    async fn call(
        &mut self,
        request: Request<'_>,
        limit: Duration,
        urgent: Urgent<'_>,
    ) -> Result<Response, BusError> {
        let sent = Instant::now();
        let mut deadline = sent + limit;
        let mut look = sent + REPLY_LIMIT_MIN;
        let mut call = pin!(self.context.call(request));
        loop {
            if let Ok(called) = timeout_at(deadline.min(look), &mut call).await {
                let closed = self.counts.closed.load(Ordering::Relaxed);
                return modbus::outcome(called, &self.place, closed);
            }
            let now = Instant::now();
            if let Some(late) = self.counts.slowest() {
                deadline = deadline.max(sent + slow_limit(late.took));
            }
            let is_overtaken = now >= sent + REPLY_LIMIT_MIN && urgent();
            if now >= deadline || is_overtaken {
                let after = now.duration_since(sent);
                return Err(BusError::Timeout { after });
            }
            look = now + URGENT_INTERVAL;
        }
    }

    async fn read_pieces(
        &mut self,
        span: Span,
        limit: Duration,
        urgent: Urgent<'_>,
    ) -> Result<Bytes, BusError> {
        let mut bytes = Bytes::new();
        for piece in self.word_use.pieces(span) {
            match piece {
                ReadPiece::Memory(part) => {
                    let request = modbus::read_request(part)?;
                    let response = self.call(request, limit, urgent).await?;
                    let packing = self.word_use.reading();
                    bytes.extend(modbus::read_response(part, &response, packing)?);
                }
                ReadPiece::Group { group, skip, take } => {
                    let count = words_per_group(BytePacking::OnePerWord);
                    let words = self.group_words(group.address, count, limit).await?;
                    modbus::append_group(&mut bytes, &words, skip, take)?;
                }
            }
        }
        Ok(bytes)
    }
}

#[async_trait]
impl Bus for ModbusTcp {
    fn has_words(&self) -> bool {
        true
    }

    fn set_packing(&mut self, found: Option<BytePacking>) {
        self.word_use.found = found;
    }

    async fn words(&mut self, address: u16, limit: Duration) -> Result<Option<Vec<u16>>, BusError> {
        let least = words_per_group(BytePacking::OnePerWord);
        self.group_words(address, least, limit).await.map(Some)
    }

    // Transaction ids distinguish replies, so the first shape always works.
    fn allows(&self, write: &RegisterWrite) -> Result<(), BusError> {
        self.word_use.allows(write)
    }

    fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        shapes.first().copied()
    }

    fn cost(&self) -> WireCost {
        WireCost::tcp()
    }

    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        self.read_pieces(span, limit, &|| false).await
    }

    async fn read_unless(
        &mut self,
        span: Span,
        limit: Duration,
        urgent: Urgent<'_>,
    ) -> Result<Option<Bytes>, BusError> {
        match self.read_pieces(span, limit, urgent).await {
            Err(BusError::Timeout { .. }) if urgent() => Ok(None),
            read => read.map(Some),
        }
    }

    async fn write(&mut self, write: PermittedWrite<'_>, limit: Duration) -> Result<(), BusError> {
        self.write_unless(write, limit, &|| false).await
    }

    async fn write_unless(
        &mut self,
        write: PermittedWrite<'_>,
        limit: Duration,
        urgent: Urgent<'_>,
    ) -> Result<(), BusError> {
        self.allows(&write)?;
        let request = modbus::write_request(&write);
        let response = self.call(request, limit, urgent).await?;
        modbus::write_response(&write, &response)
    }

    fn has_numbers(&self) -> bool {
        true
    }

    fn take_late(&mut self) -> Option<LateReply> {
        self.counts.take_slowest()
    }

    fn counts(&self) -> BusCounts {
        BusCounts {
            foreign_replies: self.counts.foreign.load(Ordering::Relaxed),
            late_replies: self.counts.late.load(Ordering::Relaxed),
            ..BusCounts::default()
        }
    }
}
