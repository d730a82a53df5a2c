//! Requests over Modbus TCP (manual 2.5), through tokio-modbus. Replies carry a number, which the filter checks.

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
}

impl ModbusTcp {
    pub(crate) fn new(wire: BoxedWire, unit: u8, endpoint: &Endpoint) -> Self {
        let counts = Arc::new(FilterCounts::default());
        let filter = ReplyFilter::new(wire, Arc::clone(&counts));
        Self {
            context: tcp::attach_slave(filter, Slave(unit)),
            counts,
            place: endpoint.place(),
        }
    }

    pub(crate) async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let response = self.call(modbus::read_request(span)?, limit).await?;
        modbus::read_response(span, &response)
    }

    pub(crate) async fn write(
        &mut self,
        write: &RegisterWrite,
        limit: Duration,
    ) -> Result<(), BusError> {
        let response = self.call(modbus::write_request(write), limit).await?;
        modbus::write_response(write, &response)
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
