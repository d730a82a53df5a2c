//! Lists the hands that other programs announce.

use crate::link::{Clock, Wake};
use crate::share::fleet::{FleetBook, FleetHand, topic};
use crate::transport::dds::{DdsMessage, DdsNode};
use std::net::Ipv4Addr;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::interval;
use tokio_util::task::AbortOnDropHandle;

/// Interval at which the list is updated.
const LIST_INTERVAL: Duration = Duration::from_millis(100);

/// Queue for hands that change at once.
const QUEUE_MAX: u16 = 512;

/// The list of announced hands. Listens until dropped.
#[derive(Debug)]
pub struct FleetList {
    interface: Ipv4Addr,
    shown: watch::Receiver<Vec<FleetHand>>,
    _task: AbortOnDropHandle<()>,
}

impl FleetList {
    /// Listens from now on; `wake` is called when the list changed. Must be called within a tokio runtime.
    pub fn open(node: &DdsNode, clock: Clock, wake: Wake) -> Self {
        let messages = node.reader(&topic(), QUEUE_MAX);
        let (sender, shown) = watch::channel(Vec::new());
        let interface = node.address();
        let listener = listen(messages, interface, clock, move |list| {
            sender.send_replace(list);
            wake();
        });
        Self {
            interface,
            shown,
            _task: AbortOnDropHandle::new(tokio::spawn(listener)),
        }
    }

    /// Address of the interface at which it listens.
    pub const fn interface(&self) -> Ipv4Addr {
        self.interface
    }

    /// Present hands, sorted by computer and name, if the list changed since the last call.
    pub fn news(&mut self) -> Option<Vec<FleetHand>> {
        let changed = self.shown.has_changed().unwrap_or_default();
        changed.then(|| self.shown.borrow_and_update().clone())
    }

    /// Waits for a change of the list and returns it; `None` once listening has ended.
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
                    is_new |= book.apply(message.from, hand, clock.now());
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
