//! Leases: the right to move a hand, held by one owner at a time, granted by the user, visible to all. Pure; the
//! control slot contains it, so that a grant, an end and what is sent under it are strictly ordered.

use crate::hand::Moment;
use crate::record::Disarmed;
use std::net::SocketAddr;

/// Kind of owner of a lease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Owner {
    /// The user of this program: its window, or its command line.
    Person,
    /// A sequence, a series of trials or another task that the user started here.
    Task,
    /// An exhibition: visitors, within the limits of its file.
    Exhibition,
    /// A gamepad at this computer.
    Gamepad,
    /// JSON lines from this sender.
    Stream(SocketAddr),
    /// A program that sends over DDS.
    Dds,
    /// A client of the gateway.
    Gateway(SocketAddr),
    /// Another hand, which this one follows.
    Mirror,
}

impl Owner {
    /// True for an owner outside this program: every view shows it, with a control to end it.
    pub const fn is_outside(self) -> bool {
        !matches!(self, Self::Person | Self::Task | Self::Exhibition)
    }

    /// True if the owner may continue after this without the user. An exhibition clears faults that can be cleared, and
    /// counts them; it opens a hot hand and lets it rest.
    const fn outlives(self, end: Disarmed) -> bool {
        matches!(
            (self, end),
            (
                Self::Exhibition,
                Disarmed::Fault | Disarmed::Hot | Disarmed::HeatUnknown
            )
        )
    }
}

/// The right to move one hand, from one grant. Invalid once another was granted, or it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Lease(u64);

/// Hold-to-run mode: motion is possible only while the user holds a key, whoever has the lease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HoldToRun {
    /// No key has to be held.
    #[default]
    Off,
    /// The key is released: arming is refused.
    Released,
    /// The key was held; valid until this time.
    Held(Moment),
}

impl HoldToRun {
    /// Time at which motion ends; `None` if no key has to be held.
    pub(crate) const fn until(self) -> Option<Moment> {
        match self {
            Self::Off => None,
            Self::Released => Some(Moment::ZERO),
            Self::Held(until) => Some(until),
        }
    }

    /// True while the key is held; `None` if no key has to be held.
    pub fn is_held(self, now: Moment) -> Option<bool> {
        self.until().map(|until| now < until)
    }
}

/// The current lease and its owner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LeaseHolder {
    /// The current lease.
    pub lease: Lease,
    /// Owner of the lease.
    pub owner: Owner,
}

/// Reason why an operation under a lease was refused. Nothing was sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LeaseRefusal {
    /// Another owner has the lease.
    #[error("another controller has control; nothing was sent")]
    Taken(Owner),
    /// The lease ended, and the user has to grant it again.
    #[error("no one has control: grant it first; nothing was sent")]
    Ended(Disarmed),
}

/// The lease of one hand, and how the last one ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LeaseBook {
    granted: u64,
    holder: Option<LeaseHolder>,
    end: Disarmed,
}

impl Default for LeaseBook {
    fn default() -> Self {
        Self {
            granted: 0,
            holder: None,
            end: Disarmed::Person,
        }
    }
}

impl LeaseBook {
    /// Grants a new lease and revokes the previous one.
    pub(crate) const fn grant(&mut self, owner: Owner) -> Lease {
        self.granted += 1;
        let lease = Lease(self.granted);
        self.holder = Some(LeaseHolder { lease, owner });
        lease
    }

    pub(crate) const fn holder(&self) -> Option<LeaseHolder> {
        self.holder
    }

    /// Checks that a lease is valid.
    pub(crate) fn check(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        match self.holder {
            Some(holder) if holder.lease == lease => Ok(()),
            Some(holder) => Err(LeaseRefusal::Taken(holder.owner)),
            None => Err(LeaseRefusal::Ended(self.end)),
        }
    }

    /// Ends the current lease, unless its owner outlives this reason.
    pub(crate) fn end(&mut self, why: Disarmed) {
        let ended = |holder: &mut LeaseHolder| !holder.owner.outlives(why);
        if self.holder.take_if(ended).is_some() {
            self.end = why;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_grant_is_the_only_one_that_holds() {
        let mut book = LeaseBook::default();
        let person = book.grant(Owner::Person);
        assert_eq!(book.check(person), Ok(()));
        let pad = book.grant(Owner::Gamepad);
        assert_eq!(book.check(person), Err(LeaseRefusal::Taken(Owner::Gamepad)));
        book.end(Disarmed::Stop);
        assert_eq!(book.check(pad), Err(LeaseRefusal::Ended(Disarmed::Stop)));
        let again = book.grant(Owner::Gamepad);
        assert_eq!(book.check(pad), Err(LeaseRefusal::Taken(Owner::Gamepad)));
        assert_eq!(book.check(again), Ok(()));
    }

    #[test]
    fn a_fault_ends_all_but_an_exhibition() {
        for (owner, holds) in [
            (Owner::Person, false),
            (Owner::Gamepad, false),
            (Owner::Exhibition, true),
        ] {
            let mut book = LeaseBook::default();
            let lease = book.grant(owner);
            book.end(Disarmed::Fault);
            assert_eq!(book.check(lease).is_ok(), holds, "{owner:?}");
            book.end(Disarmed::LinkLost);
            assert!(book.check(lease).is_err(), "{owner:?}");
        }
    }
}
