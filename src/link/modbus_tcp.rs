//! Requests over Modbus TCP (manual 2.5), through tokio-modbus. Replies carry a number, which the filter checks.

use crate::codec::modbus::BytePacking;
use crate::hand::register::{ERROR, Element, STATUS, TEMP, by_address};
use crate::hand::{RegisterWrite, Span};
use crate::link::bus::{BusCounts, BusError, Bytes};
use crate::link::filter::{FilterCounts, ReplyFilter};
use crate::link::modbus;
use crate::transport::{BoxedWire, Endpoint};
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
    packing: BytePacking,
}

/// The groups of single bytes: ERROR, STATUS, TEMP, one behind the other.
const BYTE_GROUPS: [Span; 3] = [ERROR.span(), STATUS.span(), TEMP.span()];
/// Words that the packing is judged by.
const PACKING_WORDS: u16 = 6;

impl ModbusTcp {
    pub(crate) fn new(wire: BoxedWire, unit: u8, endpoint: &Endpoint) -> Self {
        let counts = Arc::new(FilterCounts::default());
        let filter = ReplyFilter::new(wire, Arc::clone(&counts));
        Self {
            context: tcp::attach_slave(filter, Slave(unit)),
            counts,
            place: endpoint.place(),
            packing: BytePacking::default(),
        }
    }

    /// Finds out, by reading only, how this hand puts single bytes into words. Without an answer it is treated as most
    /// hands are, two a word and low byte first, but not said to be so: `None`.
    pub(crate) async fn learn(&mut self, limit: Duration) -> Result<Option<BytePacking>, BusError> {
        let request = Request::ReadHoldingRegisters(TEMP.address, PACKING_WORDS);
        let words = match self.call(request, limit).await {
            Ok(Response::ReadHoldingRegisters(words)) => words,
            Err(BusError::Lost(error)) => return Err(BusError::Lost(error)),
            Ok(_) | Err(_) => return Ok(None),
        };
        let found = words.as_slice().try_into().ok().map(BytePacking::detect);
        self.packing = found.unwrap_or_default();
        Ok(found)
    }

    pub(crate) async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        if self.packing == BytePacking::LowFirst {
            return self.read_words(span, limit).await;
        }
        let mut bytes = Bytes::new();
        let mut at = span.address;
        for group in BYTE_GROUPS {
            if u32::from(at) >= span.end() || group.end() <= u32::from(at) {
                continue;
            }
            if at < group.address {
                let until = group.address.min(end(span));
                self.append(&mut bytes, Span::new(at, until - at), limit)
                    .await?;
                at = until;
            }
            if u32::from(at) < span.end() {
                let whole = self.read_group(group, limit).await?;
                let skip = usize::from(at - group.address);
                let until = end(group).min(end(span));
                bytes.extend(whole.into_iter().skip(skip).take(usize::from(until - at)));
                at = until;
            }
        }
        if u32::from(at) < span.end() {
            self.append(&mut bytes, Span::new(at, end(span) - at), limit)
                .await?;
        }
        Ok(bytes)
    }

    pub(crate) async fn write(
        &mut self,
        write: &RegisterWrite,
        limit: Duration,
    ) -> Result<(), BusError> {
        // With bytes in other places, a word meant for one register could change its neighbour: SAVE stands beside RESET_PARA.
        if self.packing != BytePacking::LowFirst && is_bytes(write) {
            let reason = "this hand keeps single bytes in words of their own, and writing them is not known to be safe";
            return Err(BusError::Refused {
                reason: reason.into(),
            });
        }
        let response = self.call(modbus::write_request(write), limit).await?;
        modbus::write_response(write, &response)
    }

    async fn read_words(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let response = self.call(modbus::read_request(span)?, limit).await?;
        modbus::read_response(span, &response)
    }

    async fn append(
        &mut self,
        bytes: &mut Bytes,
        span: Span,
        limit: Duration,
    ) -> Result<(), BusError> {
        bytes.extend(self.read_words(span, limit).await?);
        Ok(())
    }

    async fn read_group(&mut self, group: Span, limit: Duration) -> Result<[u8; 6], BusError> {
        let count = self.packing.words_per_group();
        let request = Request::ReadHoldingRegisters(group.address, count);
        let (got, want) = match self.call(request, limit).await? {
            Response::ReadHoldingRegisters(words) => match self.packing.group(&words) {
                Some(bytes) => return Ok(bytes),
                None => (words.len() * 2, usize::from(count) * 2),
            },
            _ => (0, usize::from(count) * 2),
        };
        Err(BusError::WrongLength { got, want })
    }

    pub(crate) fn counts(&self) -> BusCounts {
        BusCounts {
            foreign_replies: self.counts.foreign.load(Ordering::Relaxed),
            ..BusCounts::default()
        }
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

/// One past the last byte, which lies below 65536 for every span that Modbus can name.
fn end(span: Span) -> u16 {
    u16::try_from(span.end()).unwrap_or(u16::MAX)
}

/// True if the write goes to registers of single bytes.
fn is_bytes(write: &RegisterWrite) -> bool {
    by_address(write.address()).is_some_and(|row| row.element == Element::Byte)
}
