//! A gateway: several Modbus TCP clients at one hand, at the addresses that the hand itself has. What they read comes from
//! what the link reads anyway, so that many cost no more than one; one of them at a time may move the hand, if a person lets it.

mod allowed;
pub mod board;
pub mod client;
pub mod refusal;
mod service;

pub use board::{CLIENTS_MAX, ClientId, GatewayClient};
pub use refusal::WriteRefusal;

use crate::link::LinkHandle;
use crate::share::gateway::client::Connection;
use crate::share::gateway::service::Service;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::runtime;
use tokio::task::{AbortHandle, JoinSet};
use tokio::time::sleep;

/// After the system refused a connection, for want of something, the next is looked for.
const ACCEPT_AGAIN: Duration = Duration::from_millis(100);

/// An open gateway. Dropping it closes its listener and all its connections.
#[derive(Debug)]
pub struct Gateway {
    address: SocketAddr,
    service: Service,
    task: AbortHandle,
}

impl Gateway {
    /// Listens at an address, for as long as it is kept. Port 0 means any free one.
    ///
    /// # Errors
    /// The system's, if the address cannot be listened at.
    pub fn open(
        link: LinkHandle,
        address: SocketAddr,
        runtime: &runtime::Handle,
    ) -> io::Result<Self> {
        let listener = std::net::TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let _inside = runtime.enter();
        let listener = TcpListener::from_std(listener)?;
        let service = Service::new(link);
        let task = runtime
            .spawn(accept_all(listener, service.clone()))
            .abort_handle();
        Ok(Self {
            address,
            service,
            task,
        })
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Who is connected, the oldest first.
    #[must_use]
    pub fn clients(&self) -> Vec<GatewayClient> {
        let now = self.service.link.clock().now();
        self.service.board.with(|board| board.shown(now))
    }

    /// Connections that were refused because there were [`CLIENTS_MAX`].
    #[must_use]
    pub fn turned_away(&self) -> u64 {
        self.service.board.with(|board| board.turned_away)
    }
}

impl Drop for Gateway {
    fn drop(&mut self) {
        self.task.abort();
    }
}

async fn accept_all(listener: TcpListener, service: Service) {
    let mut clients = JoinSet::new();
    loop {
        tokio::select! {
            biased;
            Some(_ended) = clients.join_next() => {}
            accepted = listener.accept() => match accepted {
                Ok((stream, address)) => {
                    let now = service.link.clock().now();
                    let client = service.board.with(|board| board.connect(address, now));
                    if let Some(id) = client {
                        let connection = Connection::new(service.clone(), id);
                        // Without it answers would wait for the client's acknowledgement.
                        if stream.set_nodelay(true).is_ok() {
                            clients.spawn(connection.serve(stream));
                        }
                    }
                }
                Err(_refused) => sleep(ACCEPT_AGAIN).await,
            },
        }
    }
}
