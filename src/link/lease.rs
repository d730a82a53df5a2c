//! Who may move a hand: one at a time, granted by the user, seen by everyone. Pure; the slot of what is wanted holds it, so that
//! a grant, an end and what is sent under it happen in one order.

use crate::hand::Moment;
use crate::record::Disarmed;
use std::net::SocketAddr;

/// Who may move a hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Owner {
    /// The user at this program: its window, or its command line.
    Person,
    /// A sequence, a series of trials or another task that the user started here.
    Task,
    /// An exhibition: strangers, within its file.
    Exhibition,
    /// A gamepad at this computer.
    Gamepad,
    /// Lines of JSON from this sender.
    Stream(SocketAddr),
    /// A program that sends over DDS.
    Dds,
    /// A client of the gateway.
    Gateway(SocketAddr),
    /// Another hand, which this one follows.
    Mirror,
}

impl Owner {
    /// True for one outside this program: it is told in every view, with its end in reach.
    pub const fn is_outside(self) -> bool {
        !matches!(self, Self::Person | Self::Task | Self::Exhibition)
    }

    /// True if it may go on after this without the user. An exhibition clears what can be cleared, and counts it; it opens a hot hand
    /// and lets it rest.
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

/// The right to move one hand, as granted once. Worth nothing once another was granted, or it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Lease(u64);

/// Whether motion passes only while the user holds a key: whoever has the right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HoldToRun {
    /// Nothing has to be held.
    #[default]
    Off,
    /// It is not held: nothing may be armed.
    Released,
    /// It was held, which is believed until then.
    Held(Moment),
}

impl HoldToRun {
    /// When motion passes no more, if it ever does.
    pub(crate) const fn until(self) -> Option<Moment> {
        match self {
            Self::Off => None,
            Self::Released => Some(Moment::ZERO),
            Self::Held(until) => Some(until),
        }
    }

    /// Whether it is held, if it has to be.
    pub fn is_held(self, now: Moment) -> Option<bool> {
        self.until().map(|until| now < until)
    }
}

/// Who has the right now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LeaseHolder {
    /// The right to move the hand.
    pub lease: Lease,
    /// Who holds the right.
    pub owner: Owner,
}

/// Why something was not done under a lease. Nothing was sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LeaseRefusal {
    /// Another has the right now.
    #[error("another may move the hand now: nothing was sent")]
    Taken(Owner),
    /// It ended, and the user has to grant it again.
    #[error("nobody may move the hand now, a person has to grant it: nothing was sent")]
    Ended(Disarmed),
}

/// Who may move one hand, and how the last right ended.
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
    /// The user grants the right; whoever had it has it no more.
    pub(crate) const fn grant(&mut self, owner: Owner) -> Lease {
        self.granted += 1;
        let lease = Lease(self.granted);
        self.holder = Some(LeaseHolder { lease, owner });
        lease
    }

    pub(crate) const fn holder(&self) -> Option<LeaseHolder> {
        self.holder
    }

    /// Whether this one holds.
    pub(crate) fn check(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        match self.holder {
            Some(holder) if holder.lease == lease => Ok(()),
            Some(holder) => Err(LeaseRefusal::Taken(holder.owner)),
            None => Err(LeaseRefusal::Ended(self.end)),
        }
    }

    /// Ends the right, whoever has it, unless it outlives this.
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
