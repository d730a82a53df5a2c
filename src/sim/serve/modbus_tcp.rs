//! The simulated hand as a Modbus TCP server (manual 2.5). Binds nothing: it is given a listener.

use crate::hand::Span;
use crate::sim::memory::Refusal;
use crate::sim::serve::shared::SharedHand;
use std::future::{Ready, ready};
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::net::{TcpListener, TcpStream};
use tokio_modbus::server::Service;
use tokio_modbus::server::tcp::Server;
use tokio_modbus::{ExceptionCode, Request, Response, SlaveRequest};

/// Most words of one read (manual 2.5, function 03).
const READ_WORDS_MAX: u16 = 125;
/// Most words of one write (manual 2.5, function 16).
const WRITE_WORDS_MAX: usize = 0x7B;
/// Clients at one time. A hand was seen to take two; more lets tests and viewers look on.
pub const CLIENTS_MAX: usize = 16;

/// Answers every client of `listener` until the future is dropped, which closes all connections too.
///
/// # Errors
/// The listener's own failures.
pub async fn serve(hand: SharedHand, listener: TcpListener) -> io::Result<()> {
    let clients = Arc::new(());
    let connected = |stream: TcpStream, _peer: SocketAddr| {
        let service = Memory {
            hand: hand.clone(),
            _client: Arc::clone(&clients),
        };
        // One is ours, one belongs to the client at the door.
        let full = Arc::strong_count(&clients) > CLIENTS_MAX + 1;
        async move {
            if full || stream.set_nodelay(true).is_err() {
                return Ok(None);
            }
            Ok(Some((service, stream)))
        }
    };
    // A client's broken connection ends with that client; the others go on.
    Server::new(listener).serve(&connected, |_broken| {}).await
}

/// The hand's memory as one client sees it.
struct Memory {
    hand: SharedHand,
    _client: Arc<()>,
}

impl Service for Memory {
    type Request = SlaveRequest<'static>;
    type Response = Response;
    type Exception = ExceptionCode;
    type Future = Ready<Result<Response, ExceptionCode>>;

    fn call(&self, asked: Self::Request) -> Self::Future {
        ready(self.answer(&asked.request))
    }
}

impl Memory {
    fn answer(&self, request: &Request<'_>) -> Result<Response, ExceptionCode> {
        match request {
            Request::ReadHoldingRegisters(address, count) => self
                .read(*address, *count)
                .map(Response::ReadHoldingRegisters),
            Request::WriteSingleRegister(address, word) => {
                self.write(*address, &[*word])?;
                Ok(Response::WriteSingleRegister(*address, *word))
            }
            Request::WriteMultipleRegisters(address, words) => {
                self.write(*address, words)?;
                let count = u16::try_from(words.len()).unwrap_or_default();
                Ok(Response::WriteMultipleRegisters(*address, count))
            }
            _ => Err(ExceptionCode::IllegalFunction),
        }
    }

    // Manual: 2.5 does not say how bytes become words; a word is byte[A] + 256 * byte[A + 1].
    fn read(&self, address: u16, count: u16) -> Result<Vec<u16>, ExceptionCode> {
        if !(1..=READ_WORDS_MAX).contains(&count) {
            return Err(ExceptionCode::IllegalDataValue);
        }
        let span = Span::new(address, 2 * count);
        let bytes = self
            .hand
            .with(|hand, now| hand.read(span, now))
            .map_err(exception)?;
        let (pairs, _) = bytes.as_chunks::<2>();
        Ok(pairs.iter().map(|pair| u16::from_le_bytes(*pair)).collect())
    }

    fn write(&self, address: u16, words: &[u16]) -> Result<(), ExceptionCode> {
        if words.is_empty() || words.len() > WRITE_WORDS_MAX {
            return Err(ExceptionCode::IllegalDataValue);
        }
        let bytes: Vec<u8> = match words {
            // Manual: 1000 to 1009 are single bytes side by side; one word there is one of them.
            [word] if (1000..=1009).contains(&address) => match u8::try_from(*word) {
                Ok(value) => vec![value],
                Err(_) => return Ok(()),
            },
            _ => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
        };
        self.hand.with(|hand, now| {
            let effect = hand.write(address, &bytes, now).map_err(exception)?;
            if effect.result_follows {
                hand.cancel_newest_save_result();
            }
            Ok(())
        })
    }
}

const fn exception(refusal: Refusal) -> ExceptionCode {
    match refusal {
        Refusal::Unmapped { .. } | Refusal::Gap => ExceptionCode::IllegalDataAddress,
        Refusal::Empty { .. } => ExceptionCode::IllegalDataValue,
    }
}
