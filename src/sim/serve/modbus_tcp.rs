//! Simulated hands as a Modbus TCP server (manual 2.5). Binds nothing: it is given a listener.

use crate::sim::serve::hands::Hands;
use crate::sim::serve::modbus::Memory;
use std::future::{Ready, ready};
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::net::{TcpListener, TcpStream};
use tokio_modbus::server::Service;
use tokio_modbus::server::tcp::Server;
use tokio_modbus::{ExceptionCode, Response, SlaveRequest};

/// Clients at one time. A hand was seen to take two; more lets tests and viewers look on.
pub const CLIENTS_MAX: usize = 16;

/// Answers every client of `listener` until the future is dropped, which closes all connections too. One hand answers
/// to every unit id; of several, 255 and 0 mean the first, other units the hand of that id, and a unit that no hand
/// has gets the exception of a gateway whose target is silent.
///
/// # Errors
/// The listener's own failures.
pub async fn serve(hands: impl Into<Hands>, listener: TcpListener) -> io::Result<()> {
    let hands = hands.into();
    let clients = Arc::new(());
    let connected = |stream: TcpStream, _peer: SocketAddr| {
        let service = Client {
            hands: hands.clone(),
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

/// One client; the clients are counted by what they hold.
struct Client {
    hands: Hands,
    _client: Arc<()>,
}

impl Service for Client {
    type Request = SlaveRequest<'static>;
    type Response = Response;
    type Exception = ExceptionCode;
    type Future = Ready<Result<Response, ExceptionCode>>;

    fn call(&self, asked: Self::Request) -> Self::Future {
        ready(match self.hands.unit(asked.slave) {
            Some(hand) => Memory::new(hand.clone()).answer(&asked.request),
            None => Err(ExceptionCode::GatewayTargetDevice),
        })
    }
}
