//! Announces one shared hand.

use crate::link::{LinkHandle, LinkStatus};
use crate::share::fleet::{ANNOUNCE_INTERVAL, FleetCard, FleetHand, reachable, topic};
use crate::transport::dds::{DdsNode, DdsWriter};
use std::net::Ipv4Addr;
use tokio::sync::watch;
use tokio::time::sleep;
use tokio_util::task::AbortOnDropHandle;

/// Announces a hand until dropped, or until the link is closed.
#[derive(Debug)]
pub struct FleetAnnouncer {
    card: watch::Sender<FleetCard>,
    _task: AbortOnDropHandle<()>,
}

impl FleetAnnouncer {
    /// Announces this hand from now on, with the status of its link; its gateway only if listeners can reach it. Must be
    /// called within a tokio runtime.
    pub fn open(node: &DdsNode, link: &LinkHandle, card: FleetCard) -> Self {
        let publisher = FleetPublisher {
            writer: node.writer(&topic()),
            interface: node.address(),
            status: link.observe().status,
        };
        let (card, cards) = watch::channel(card);
        Self {
            card,
            _task: AbortOnDropHandle::new(tokio::spawn(publisher.run(cards))),
        }
    }

    /// Announces it with this card from now on.
    pub fn announce(&self, card: FleetCard) {
        self.card.send_if_modified(|current| {
            let is_new = *current != card;
            *current = card;
            is_new
        });
    }
}

struct FleetPublisher {
    writer: DdsWriter,
    interface: Ipv4Addr,
    status: watch::Receiver<LinkStatus>,
}

impl FleetPublisher {
    async fn run(mut self, mut cards: watch::Receiver<FleetCard>) {
        let of = |status: &LinkStatus| (status.state, status.holder.map(|holder| holder.owner));
        loop {
            let mut card = cards.borrow_and_update().clone();
            card.at = card.at.and_then(|at| reachable(at, self.interface));
            let published = of(&self.status.borrow_and_update());
            let (state, owner) = published;
            // A lost announcement is soon repeated.
            let _is_sent = self.writer.send(FleetHand { card, state, owner }.message());
            // Random pauses, so that announcers that started together do not stay in step.
            let pause = ANNOUNCE_INTERVAL.mul_f64(0.75 + 0.25 * fastrand::f64());
            let is_open = tokio::select! {
                changed = self.status.wait_for(|status| of(status) != published) => changed.is_ok(),
                changed = cards.changed() => changed.is_ok(),
                () = sleep(pause) => true,
            };
            if !is_open {
                return;
            }
        }
    }
}

/// Name of this computer.
pub fn host() -> String {
    #[cfg(unix)]
    let name = nix::unistd::gethostname()
        .ok()
        .map(|name| name.to_string_lossy().into_owned());
    #[cfg(not(unix))]
    let name = std::env::var("COMPUTERNAME").ok();
    name.unwrap_or_default()
}
