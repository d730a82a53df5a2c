//! Detects other programs whose hand of the same side follows sent targets: two hands must not obey one sender unasked.

use crate::hand::kinematics::Side;
use crate::link::Clock;
use crate::share::fleet::{FleetBook, FleetCard, FleetHand, topic};
use crate::transport::dds::{DdsMessage, DdsNode};
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::{interval, timeout};
use tokio_util::task::AbortOnDropHandle;

/// Time within which an announcement arrives, even with two notices lost.
const SILENCE_TIMEOUT: Duration = Duration::from_millis(2000);
/// Interval at which silent announcers are removed.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Queue for hands that change at once.
const QUEUE_MAX: u16 = 512;

/// Other hands of this side that follow the targets sent in this domain. Listens until dropped.
#[derive(Debug)]
pub struct OtherFollowers {
    seen: watch::Receiver<Option<FleetCard>>,
    _task: AbortOnDropHandle<()>,
}

impl OtherFollowers {
    /// Listens from now on. Must be called within a tokio runtime.
    pub fn open(node: &DdsNode, side: Side, clock: Clock) -> Self {
        let messages = node.reader(&topic(), QUEUE_MAX);
        let (sender, seen) = watch::channel(None);
        let listener = FleetListener {
            node: node.clone(),
            side,
            clock,
            sender,
        };
        Self {
            seen,
            _task: AbortOnDropHandle::new(tokio::spawn(listener.run(messages))),
        }
    }

    /// Returns such a hand if one is present now.
    pub fn now(&self) -> Option<FleetCard> {
        self.seen.borrow().clone()
    }

    /// Waits until such a hand is present, and returns it.
    pub async fn appears(&self) -> FleetCard {
        let mut seen = self.seen.clone();
        let appeared = seen.wait_for(Option::is_some).await;
        match appeared.ok().and_then(|card| card.clone()) {
            Some(card) => card,
            None => std::future::pending().await,
        }
    }

    /// Returns such a hand if it was present before listening began; waits up to the announcement timeout.
    pub async fn was_there(&self) -> Option<FleetCard> {
        timeout(SILENCE_TIMEOUT, self.appears()).await.ok()
    }
}

struct FleetListener {
    node: DdsNode,
    side: Side,
    clock: Clock,
    sender: watch::Sender<Option<FleetCard>>,
}

impl FleetListener {
    async fn run(self, mut messages: mpsc::Receiver<DdsMessage>) {
        let mut book = FleetBook::default();
        let mut tick = interval(POLL_INTERVAL);
        loop {
            let is_new = tokio::select! {
                message = messages.recv() => {
                    let Some(message) = message else { return };
                    let hand = FleetHand::parse(&message.bytes, self.node.address());
                    let hand = hand.filter(|_| !self.node.wrote(&message));
                    hand.is_some_and(|hand| book.apply(message.from, hand, self.clock.now()))
                }
                _ = tick.tick() => book.sweep(self.clock.now()),
            };
            if is_new {
                let follows = |hand: &FleetHand| hand.card.follows && hand.card.side == self.side;
                let other = book.list().into_iter().find(follows);
                self.sender.send_replace(other.map(|hand| hand.card));
            }
        }
    }
}
