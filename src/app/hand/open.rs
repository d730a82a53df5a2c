//! An open link, a hand that is being left, and requests whose end is awaited.

use crate::app::notices::RequestKind;
use crate::hand::Moment;
use crate::link::{Lease, LinkHandle, Owner, Records, RequestError};
use crate::store::BackgroundJob;
use crate::transport::Endpoint;

#[derive(Debug)]
pub(crate) struct OpenLink {
    pub(crate) link: LinkHandle,
    pub(crate) records: Records,
    /// The right to move the hand that the user at this window, or their task, had last.
    pub(crate) lease: Option<Lease>,
}

impl OpenLink {
    /// With this link and what is heard of it.
    pub(crate) fn new((link, records): (LinkHandle, Records)) -> Self {
        Self {
            lease: None,
            link,
            records,
        }
    }

    /// The right of the user at this window to move the hand; granted anew if another has it, or none.
    pub(crate) fn take_lease(&mut self) -> Lease {
        let held = self.link.status().holder;
        let held = held.filter(|holder| holder.owner == Owner::Person);
        self.granted(held.map(|holder| holder.lease), Owner::Person)
    }

    /// The right of a task that this person starts. What they set meanwhile passes too.
    pub(crate) fn lend_lease(&mut self) -> Lease {
        self.granted(None, Owner::Task)
    }

    fn granted(&mut self, held: Option<Lease>, owner: Owner) -> Lease {
        let lease = held.unwrap_or_else(|| self.link.grant(owner));
        self.lease = Some(lease);
        lease
    }
}

/// A hand that is being left: it was told to hold.
#[derive(Debug)]
pub(crate) struct Leaving {
    /// Where to go then; `None` = nowhere.
    pub(crate) to: Option<Endpoint>,
    pub(crate) told: Moment,
}

/// A request whose end is awaited.
#[derive(Debug)]
pub(crate) struct Pending {
    pub(crate) what: RequestKind,
    pub(crate) end: Option<BackgroundJob<Result<(), RequestError>>>,
}
