//! Requests over Modbus TCP (manual 2.5), through tokio-modbus. Replies carry a number, which the filter checks.

use crate::codec::modbus::{ModbusWrite, bytes_from_words, words_for, words_from_write};
use crate::hand::{RegisterWrite, Span};
use crate::link::bus::{BusCounts, BusError, Bytes};
use crate::link::filter::{FilterCounts, ReplyFilter};
use crate::transport::{BoxedWire, Endpoint, TransportError};
use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use tokio::time::timeout;
use tokio_modbus::client::{Client as _, Context, tcp};
use tokio_modbus::{Error, ProtocolError, Request, Response, Slave};

/// Most words that one read can carry (manual 2.5.1).
const WORDS_MAX: u16 = 125;

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
            place: endpoint.to_string(),
        }
    }

    pub(crate) async fn read(&mut self, span: Span, limit: Duration) -> Result<Bytes, BusError> {
        let words = words_for(span);
        if words.count > WORDS_MAX || words.count == 0 {
            return Err(BusError::TooLong);
        }
        let request = Request::ReadHoldingRegisters(words.address, words.count);
        let got = match self.call(request, limit).await? {
            Response::ReadHoldingRegisters(got) => got,
            _ => {
                return Err(BusError::WrongLength {
                    got: 0,
                    want: usize::from(span.len),
                });
            }
        };
        // The library checks the number of words only in debug builds.
        if got.len() != usize::from(words.count) {
            return Err(BusError::WrongLength {
                got: got.len() * 2,
                want: usize::from(span.len),
            });
        }
        let bytes = bytes_from_words(&got);
        let bytes = bytes
            .iter()
            .copied()
            .take(usize::from(span.len))
            .take(Bytes::new().capacity());
        Ok(bytes.collect())
    }

    pub(crate) async fn write(
        &mut self,
        write: &RegisterWrite,
        limit: Duration,
    ) -> Result<(), BusError> {
        let request = match words_from_write(write) {
            ModbusWrite::Single { address, value } => Request::WriteSingleRegister(address, value),
            ModbusWrite::Multiple { address, words } => {
                Request::WriteMultipleRegisters(address, Cow::Owned(words.to_vec()))
            }
        };
        let expected = request.clone();
        match (self.call(request, limit).await?, expected) {
            // Manual: 2.4.2 prints zeros in the reply to FC06 where the standard echoes; both pass.
            (Response::WriteSingleRegister(..), Request::WriteSingleRegister(..)) => Ok(()),
            (
                Response::WriteMultipleRegisters(at, count),
                Request::WriteMultipleRegisters(address, words),
            ) if at == address && usize::from(count) == words.len() => Ok(()),
            _ => Err(BusError::WrongLength {
                got: 0,
                want: write.bytes().len(),
            }),
        }
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
            Ok(Ok(Ok(response))) => Ok(response),
            Ok(Ok(Err(exception))) => Err(BusError::Refused {
                reason: exception.to_string(),
            }),
            Ok(Err(Error::Protocol(error))) => Err(self.broken(&error)),
            Ok(Err(Error::Transport(error))) => Err(BusError::Lost(self.lost(&error))),
        }
    }

    fn broken(&self, error: &ProtocolError) -> BusError {
        BusError::Lost(TransportError::Io {
            place: self.place.clone(),
            message: error.to_string(),
        })
    }

    fn lost(&self, error: &std::io::Error) -> TransportError {
        let place = self.place.clone();
        let closed = self.counts.closed.load(Ordering::Relaxed);
        // Where the other side closes, the library passes on whatever error the system had last.
        if closed
            || error.kind() == std::io::ErrorKind::ConnectionReset
            || error.kind() == std::io::ErrorKind::BrokenPipe
        {
            return TransportError::HungUp { place };
        }
        TransportError::Io {
            place,
            message: error.to_string(),
        }
    }
}
