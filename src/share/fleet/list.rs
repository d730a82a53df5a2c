//! Listens to who tells of hands.

use crate::link::{Clock, Wake};
use crate::share::fleet::{FleetBook, FleetHand, topic};
use crate::transport::dds::{DdsMessage, DdsNode};
use std::net::Ipv4Addr;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::interval;
use tokio_util::task::AbortOnDropHandle;

/// How often the list is looked through, and may change for those who look at it.
const LIST_INTERVAL: Duration = Duration::from_millis(100);

/// As many hands may change at once.
const KEPT: u16 = 512;

/// The list of hands, kept. Dropped, nobody listens any more.
#[derive(Debug)]
pub struct FleetList {
    interface: Ipv4Addr,
    shown: watch::Receiver<Vec<FleetHand>>,
    _task: AbortOnDropHandle<()>,
}

impl FleetList {
    /// Listens from now on; `wake` is called when the list changed. Must be called within a tokio runtime.
    pub fn open(node: &DdsNode, clock: Clock, wake: Wake) -> Self {
        let messages = node.reader(&topic(), KEPT);
        let (told, shown) = watch::channel(Vec::new());
        let interface = node.address();
        let listening = listen(messages, interface, clock, move |list| {
            told.send_replace(list);
            wake();
        });
        Self {
            interface,
            shown,
            _task: AbortOnDropHandle::new(tokio::spawn(listening)),
        }
    }

    /// The address of the interface at which it listens.
    pub const fn interface(&self) -> Ipv4Addr {
        self.interface
    }

    /// The hands that are there now, by computer and name, if that changed since the last call.
    pub fn news(&mut self) -> Option<Vec<FleetHand>> {
        let changed = self.shown.has_changed().unwrap_or_default();
        changed.then(|| self.shown.borrow_and_update().clone())
    }

    /// The same, once it changed; `None` once nobody listens.
    pub async fn changed(&mut self) -> Option<Vec<FleetHand>> {
        self.shown.changed().await.ok()?;
        Some(self.shown.borrow_and_update().clone())
    }
}

async fn listen(
    mut messages: mpsc::Receiver<DdsMessage>,
    interface: Ipv4Addr,
    clock: Clock,
    show: impl Fn(Vec<FleetHand>),
) {
    let mut book = FleetBook::default();
    let mut tick = interval(LIST_INTERVAL);
    let mut is_new = false;
    loop {
        tokio::select! {
            message = messages.recv() => {
                let Some(message) = message else { return };
                if let Some(hand) = FleetHand::parse(&message.bytes, interface) {
                    is_new |= book.take(message.from, hand, clock.now());
                }
            }
            _ = tick.tick() => {
                is_new |= book.sweep(clock.now());
                if std::mem::take(&mut is_new) {
                    show(book.list());
                }
            }
        }
    }
}
