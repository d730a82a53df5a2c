//! A hand for live viewers: the topics of its recording over the Foxglove WebSocket protocol, in the same bytes, as they happen.
//! Viewers look on; nothing that they say reaches the hand.

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
use crate::share::foxglove::viewer::Connection;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::runtime;
use tokio::task::JoinSet;
use tokio::time::sleep;

/// After the system refused a connection, for want of something, the next is looked for.
const ACCEPT_AGAIN: Duration = Duration::from_millis(100);

/// How a server is opened.
#[derive(Debug, Clone)]
pub struct FoxgloveConfig {
    /// Where it listens. Port 0 means any free one.
    pub address: SocketAddr,
    /// Which hand is shown, and from when its moments count, as a recording of it would begin.
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
    /// Listens for as long as it is kept. It shows nothing by itself.
    ///
    /// # Errors
    /// The system's, if the address cannot be listened at.
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

    /// Shows what happens at a link from now on. It does not keep the link open.
    pub fn show(&mut self, link: &LinkHandle) {
        let _inside = self.runtime.enter();
        let entries = LinkEntries::new(link.observe(), link.clock());
        let feeds = feed(entries, self.opening.clone(), self.outlet.clone());
        self.tasks.spawn(feeds);
    }

    /// Where it listens.
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where messages go in.
    pub const fn outlet(&self) -> &Outlet {
        &self.outlet
    }

    /// Who views, the oldest first.
    pub fn viewers(&self) -> Vec<Viewer> {
        self.outlet.viewers()
    }

    /// Connections that were refused because there were [`VIEWERS_MAX`].
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
                    let connection = Connection::new(seat, Arc::clone(&greeting));
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
