//! A gateway: several Modbus TCP clients share one hand, at the hand's own addresses. Their reads are served from the link's
//! regular readings, so that many clients cost the same as one; one client at a time can get control of the hand, if the user allows it.

mod allowed;
pub mod client;
pub mod clients;
pub mod leases;
pub mod refusal;
mod service;

pub use clients::{CLIENTS_MAX, ClientId, ClientLease, GatewayClient, MoverChange, MoverEvent};
pub use leases::Writers;
pub use refusal::WriteRefusal;

use crate::link::LinkHandle;
use crate::share::gateway::client::ClientConnection;
use crate::share::gateway::clients::ClientTable;
use crate::share::gateway::leases::ClientLeases;
use crate::share::gateway::service::Service;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::runtime;
use tokio::task::JoinSet;
use tokio::time::{MissedTickBehavior, interval, sleep};
use tokio_util::task::AbortOnDropHandle;

/// Default silence, without any request, after which a client loses control.
pub const SILENCE: Duration = Duration::from_secs(10);
/// Interval of the check for silent clients.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Delay before the next accept after the system refused a connection for lack of resources.
const ACCEPT_AGAIN: Duration = Duration::from_millis(100);

/// Configuration of a gateway.
#[derive(Debug, Clone, Copy)]
pub struct GatewayConfig {
    /// Listen address. Port 0 means any free one.
    pub address: SocketAddr,
    /// Clients that can get control of the hand.
    pub writers: Writers,
    /// Silence, without any request, after which a client loses control.
    pub silence: Duration,
}

/// An open gateway. Dropping it closes its listener and all its connections, and stops the hand if a client has control.
#[derive(Debug)]
pub struct Gateway {
    address: SocketAddr,
    leases: ClientLeases,
    _task: AbortOnDropHandle<()>,
}

impl Gateway {
    /// Listens until dropped.
    ///
    /// # Errors
    /// The system's error if the address cannot be bound.
    pub fn open(
        link: LinkHandle,
        config: GatewayConfig,
        runtime: &runtime::Handle,
    ) -> io::Result<Self> {
        let listener = std::net::TcpListener::bind(config.address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let _inside = runtime.enter();
        let listener = TcpListener::from_std(listener)?;
        let leases = ClientLeases::new(link, config.writers, config.silence);
        let task = AbortOnDropHandle::new(runtime.spawn(serve(listener, leases.clone())));
        Ok(Self {
            address,
            leases,
            _task: task,
        })
    }

    /// Listen address, with the actual port.
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Connected clients, the oldest first.
    pub fn clients(&self) -> Vec<GatewayClient> {
        let now = self.leases.link.clock().now();
        self.leases.table.with(|table| table.shown(now))
    }

    /// Control changes since the last call, each one, in order.
    pub fn movers(&self) -> Vec<MoverEvent> {
        self.leases.table.with(ClientTable::take_events)
    }

    /// Number of connections refused because there were [`CLIENTS_MAX`].
    pub fn turned_away(&self) -> u64 {
        self.leases.table.with(|table| table.turned_away)
    }

    /// Grants this client control of the hand: the present holder loses it, and the hand is armed with its present speeds and
    /// forces. Call only at the user's request. The result is the client's [`GatewayClient::lease`], or its refusal.
    pub fn grant(&self, client: ClientId) {
        let notify = |row: &mut clients::Client| row.granted.notify_one();
        self.leases
            .table
            .with(|table| table.row(client).map(notify));
    }
}

impl Drop for Gateway {
    fn drop(&mut self) {
        self.leases.close();
    }
}

async fn serve(listener: TcpListener, leases: ClientLeases) {
    let mut clients = JoinSet::new();
    let mut status = leases.link.observe().status;
    let mut tick = interval(POLL_INTERVAL);
    tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        tokio::select! {
            biased;
            changed = status.changed() => match changed {
                Ok(()) => leases.end_stale_lease(),
                Err(_gone) => return,
            },
            _ = tick.tick() => leases.end_stale_lease(),
            Some(_ended) = clients.join_next() => {}
            accepted = listener.accept() => match accepted {
                Ok((stream, address)) => begin(&mut clients, &leases, stream, address),
                Err(_refused) => sleep(ACCEPT_AGAIN).await,
            },
        }
    }
}

/// Serves a new client, or refuses it.
fn begin(clients: &mut JoinSet<()>, leases: &ClientLeases, stream: TcpStream, address: SocketAddr) {
    let now = leases.link.clock().now();
    let Some(id) = leases.table.with(|table| table.connect(address, now)) else {
        return;
    };
    let service = Service {
        leases: leases.clone(),
    };
    let connection = ClientConnection::new(service, id);
    // Without it answers would wait for the client's acknowledgement.
    if stream.set_nodelay(true).is_ok() {
        clients.spawn(connection.serve(stream));
    }
}
