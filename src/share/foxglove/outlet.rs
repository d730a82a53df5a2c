//! Distributes messages to all viewers: each message is encoded once, and each viewer receives its own topics. A viewer that is too
//! slow misses the oldest; the publisher never waits.

use crate::record::file::format::encode::EncodedMessage;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::broadcast;

/// Concurrent viewers; further connections are refused at once.
pub const VIEWERS_MAX: usize = 8;
/// Messages that wait for the slowest viewer: more than a second of a hand with all its wire traffic.
pub const BACKLOG_MAX: usize = 1024;

/// One viewer, as shown to the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Viewer {
    pub address: SocketAddr,
    /// Number of subscribed topics.
    pub topics: usize,
    /// Number of messages sent to it.
    pub sent: u64,
    /// Messages, of all topics, missed because it was too slow.
    pub missed: u64,
}

/// Entry point for messages. Clones share the same viewers.
#[derive(Debug, Clone)]
pub struct Outlet {
    messages: broadcast::Sender<Arc<EncodedMessage>>,
    table: Arc<Mutex<ViewerTable>>,
}

/// Identifies a connection of one server; never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ViewerId(u64);

#[derive(Debug, Default)]
struct ViewerTable {
    viewers: Vec<(ViewerId, Viewer)>,
    last_id: u64,
    turned_away: u64,
}

impl Outlet {
    pub(crate) fn new() -> Self {
        Self {
            messages: broadcast::Sender::new(BACKLOG_MAX),
            table: Arc::default(),
        }
    }

    /// True if any viewer would receive a message.
    pub fn is_viewed(&self) -> bool {
        self.messages.receiver_count() > 0
    }

    /// Sends a message to all subscribers of its topic. Does not wait.
    pub fn publish(&self, message: EncodedMessage) {
        // Having no viewers is no error.
        let _viewers = self.messages.send(Arc::new(message));
    }

    /// Connected viewers, the oldest first.
    pub(crate) fn viewers(&self) -> Vec<Viewer> {
        self.with(|table| table.viewers.iter().map(|(_, viewer)| *viewer).collect())
    }

    pub(crate) fn turned_away(&self) -> u64 {
        self.with(|table| table.turned_away)
    }

    /// Adds a new viewer, unless there are too many.
    pub(crate) fn connect(&self, address: SocketAddr) -> Option<Seat> {
        let id = self.with(|table| table.connect(address))?;
        Some(Seat {
            outlet: self.clone(),
            id,
        })
    }

    fn with<T>(&self, act: impl FnOnce(&mut ViewerTable) -> T) -> T {
        // Each call leaves the table consistent, even one that panicked.
        act(&mut self.table.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl ViewerTable {
    fn connect(&mut self, address: SocketAddr) -> Option<ViewerId> {
        if self.viewers.len() >= VIEWERS_MAX {
            self.turned_away += 1;
            return None;
        }
        self.last_id += 1;
        let id = ViewerId(self.last_id);
        let viewer = Viewer {
            address,
            topics: 0,
            sent: 0,
            missed: 0,
        };
        self.viewers.push((id, viewer));
        Some(id)
    }
}

/// Place of one viewer, freed when dropped, however its connection ends.
#[derive(Debug)]
pub(crate) struct Seat {
    outlet: Outlet,
    id: ViewerId,
}

impl Seat {
    /// Subscribes to the messages from now on.
    pub(crate) fn messages(&self) -> broadcast::Receiver<Arc<EncodedMessage>> {
        self.outlet.messages.subscribe()
    }

    /// Updates the viewer's entry.
    pub(crate) fn note(&self, what: impl FnOnce(&mut Viewer)) {
        self.outlet.with(|table| {
            let ours = table.viewers.iter_mut().find(|(id, _)| *id == self.id);
            if let Some((_, viewer)) = ours {
                what(viewer);
            }
        });
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.outlet
            .with(|table| table.viewers.retain(|(id, _)| *id != self.id));
    }
}
