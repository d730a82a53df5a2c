//! Tells of one hand that is shared.

use crate::link::{LinkHandle, LinkStatus};
use crate::share::fleet::{ANNOUNCE_INTERVAL, FleetCard, FleetHand, reachable, topic};
use crate::transport::dds::{DdsNode, DdsWriter};
use std::net::Ipv4Addr;
use tokio::sync::watch;
use tokio::time::sleep;
use tokio_util::task::AbortOnDropHandle;

/// Tells of a hand. Dropped, or once the link is closed, it tells nothing any more.
#[derive(Debug)]
pub struct FleetTeller {
    card: watch::Sender<FleetCard>,
    _task: AbortOnDropHandle<()>,
}

impl FleetTeller {
    /// Tells of this hand from now on, with what its link says of itself; of its gateway only if those who listen reach it. Must be
    /// called within a tokio runtime.
    pub fn open(node: &DdsNode, link: &LinkHandle, card: FleetCard) -> Self {
        let telling = Publishing {
            writer: node.writer(&topic()),
            interface: node.address(),
            status: link.observe().status,
        };
        let (card, cards) = watch::channel(card);
        Self {
            card,
            _task: AbortOnDropHandle::new(tokio::spawn(telling.run(cards))),
        }
    }

    /// Says this of it from now on.
    pub fn say(&self, card: FleetCard) {
        self.card.send_if_modified(|said| {
            let is_new = *said != card;
            *said = card;
            is_new
        });
    }
}

struct Publishing {
    writer: DdsWriter,
    interface: Ipv4Addr,
    status: watch::Receiver<LinkStatus>,
}

impl Publishing {
    async fn run(mut self, mut cards: watch::Receiver<FleetCard>) {
        let of = |status: &LinkStatus| (status.state, status.holder.map(|holder| holder.owner));
        loop {
            let mut card = cards.borrow_and_update().clone();
            card.at = card.at.and_then(|at| reachable(at, self.interface));
            let told = of(&self.status.borrow_and_update());
            let (state, owner) = told;
            // One that is lost is told again soon.
            let _is_sent = self.writer.send(FleetHand { card, state, owner }.message());
            // Of many that began together not all speak at once for ever.
            let pause = ANNOUNCE_INTERVAL.mul_f64(0.75 + 0.25 * fastrand::f64());
            let is_open = tokio::select! {
                changed = self.status.wait_for(|status| of(status) != told) => changed.is_ok(),
                changed = cards.changed() => changed.is_ok(),
                () = sleep(pause) => true,
            };
            if !is_open {
                return;
            }
        }
    }
}

/// What this computer is called.
pub fn host() -> String {
    #[cfg(unix)]
    let name = nix::unistd::gethostname()
        .ok()
        .map(|name| name.to_string_lossy().into_owned());
    #[cfg(not(unix))]
    let name = std::env::var("COMPUTERNAME").ok();
    name.unwrap_or_default()
}
