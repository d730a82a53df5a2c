//! Live view of a hand: the topics of its recording over the Foxglove WebSocket protocol, in the same bytes, as they occur.
//! Viewers only receive; nothing that they send reaches the hand.

pub mod allowance;
mod feed;
pub mod outlet;
pub mod protocol;
pub mod viewer;

pub use outlet::{BACKLOG_MAX, Outlet, VIEWERS_MAX, Viewer};

use crate::link::{LinkEntries, LinkHandle};
use crate::record::file::Opening;
use crate::share::foxglove::feed::feed;
use crate::share::foxglove::protocol::Greeting;
use crate::share::foxglove::viewer::ViewerConnection;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::runtime;
use tokio::task::JoinSet;
use tokio::time::sleep;

/// Delay before the next accept after the system refused a connection for lack of resources.
const ACCEPT_AGAIN: Duration = Duration::from_millis(100);

/// Configuration of a server.
#[derive(Debug, Clone)]
pub struct FoxgloveConfig {
    /// Listen address. Port 0 means any free one.
    pub address: SocketAddr,
    /// Hand and time base, as in the opening of a recording.
    pub opening: Opening,
}

/// A server for viewers. Dropping it closes its listener and all its connections.
#[derive(Debug)]
pub struct FoxgloveServer {
    address: SocketAddr,
    opening: Opening,
    outlet: Outlet,
    runtime: runtime::Handle,
    tasks: JoinSet<()>,
}

impl FoxgloveServer {
    /// Listens until dropped. Shows nothing before [`Self::show`] is called.
    ///
    /// # Errors
    /// The system's error if the address cannot be bound.
    pub fn open(config: FoxgloveConfig, runtime: &runtime::Handle) -> io::Result<Self> {
        let listener = std::net::TcpListener::bind(config.address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let _inside = runtime.enter();
        let listener = TcpListener::from_std(listener)?;
        let outlet = Outlet::new();
        let greeting = Arc::new(Greeting::new(&config.opening));
        let mut tasks = JoinSet::new();
        tasks.spawn(serve(listener, outlet.clone(), greeting));
        Ok(Self {
            address,
            opening: config.opening,
            outlet,
            runtime: runtime.clone(),
            tasks,
        })
    }

    /// Shows the events of a link from now on. Does not keep the link open.
    pub fn show(&mut self, link: &LinkHandle) {
        let _inside = self.runtime.enter();
        let entries = LinkEntries::new(link.observe(), link.clock());
        let feeds = feed(entries, self.opening.clone(), self.outlet.clone());
        self.tasks.spawn(feeds);
    }

    /// Listen address, with the actual port.
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Entry point for messages.
    pub const fn outlet(&self) -> &Outlet {
        &self.outlet
    }

    /// Connected viewers, the oldest first.
    pub fn viewers(&self) -> Vec<Viewer> {
        self.outlet.viewers()
    }

    /// Number of connections refused because there were [`VIEWERS_MAX`].
    pub fn turned_away(&self) -> u64 {
        self.outlet.turned_away()
    }
}

async fn serve(listener: TcpListener, outlet: Outlet, greeting: Arc<Greeting>) {
    let mut viewers = JoinSet::new();
    loop {
        tokio::select! {
            biased;
            Some(_ended) = viewers.join_next() => {}
            accepted = listener.accept() => match accepted {
                Ok((stream, address)) => {
                    let Some(seat) = outlet.connect(address) else { continue };
                    let connection = ViewerConnection::new(seat, Arc::clone(&greeting));
                    // Without it messages would wait for the viewer's acknowledgement, up to 40 ms.
                    if stream.set_nodelay(true).is_ok() {
                        viewers.spawn(connection.serve(stream));
                    }
                }
                Err(_refused) => sleep(ACCEPT_AGAIN).await,
            },
        }
    }
}
