//! Requests over Modbus TCP (manual 2.5), through tokio-modbus. Replies carry a number, which the filter checks.

use crate::codec::modbus::words_per_group;
use crate::hand::register::BytePacking;
use crate::hand::{RegisterWrite, Span};
use crate::link::bus::client::Bus;
use crate::link::bus::error::{BusCounts, BusError, Bytes};
use crate::link::bus::filter::{FilterCounts, ReplyFilter};
use crate::link::bus::modbus;
use crate::link::bus::packing::{ReadPiece, WordUse};
use crate::link::poll::cost::WireCost;
use crate::transport::{BoxedWire, Endpoint};
use async_trait::async_trait;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use tokio::time::timeout;
use tokio_modbus::client::{Client as _, Context, tcp};
use tokio_modbus::{Request, Response, Slave};

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

    /// Words as they come, for judging how bytes stand in them.
    async fn group_words(
        &mut self,
        address: u16,
        count: u16,
        limit: Duration,
    ) -> Result<Vec<u16>, BusError> {
        let request = modbus::words_request(address, count);
        modbus::words_response(count, self.call(request, limit).await?)
    }

    async fn call(&mut self, request: Request<'_>, limit: Duration) -> Result<Response, BusError> {
        match timeout(limit, self.context.call(request)).await {
            Err(_) => Err(BusError::Timeout { after: limit }),
            Ok(called) => {
                let closed = self.counts.closed.load(Ordering::Relaxed);
                modbus::outcome(called, &self.place, closed)
            }
        }
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

    // Transaction ids tell replies apart, so the first serves always.
    fn choose(&mut self, shapes: &[Span]) -> Option<Span> {
        shapes.first().copied()
    }

    fn cost(&self) -> WireCost {
        WireCost::tcp()
    }

    async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let mut bytes = Bytes::new();
        for piece in self.word_use.pieces(span) {
            match piece {
                ReadPiece::Memory(part) => {
                    let request = modbus::read_request(part)?;
                    let response = self.call(request, limit).await?;
                    let packing = self.word_use.reading();
                    bytes.extend(modbus::read_response(part, &response, packing)?);
                }
                ReadPiece::Group { group, skip, take } => {
                    let count = words_per_group(BytePacking::OnePerWord);
                    let words = self.group_words(group.address, count, limit).await?;
                    modbus::take_group(&mut bytes, &words, skip, take)?;
                }
            }
        }
        Ok(bytes)
    }

    async fn write(&mut self, write: &RegisterWrite, limit: Duration) -> Result<(), BusError> {
        self.word_use.allows(write)?;
        let response = self.call(modbus::write_request(write), limit).await?;
        modbus::write_response(write, &response)
    }

    fn counts(&self) -> BusCounts {
        BusCounts {
            foreign_replies: self.counts.foreign.load(Ordering::Relaxed),
            ..BusCounts::default()
        }
    }
}
