//! The fleet: hands that Handscopes share, announced over DDS by the sharing programs and listed by the others. Discovery is
//! left to DDS; a hand's link has no part in it.

mod announcer;
mod book;
mod followers;
mod list;
mod notice;
#[cfg(test)]
mod tests;

pub use announcer::{FleetAnnouncer, host};
pub use book::{FleetBook, HANDS_MAX};
pub use followers::OtherFollowers;
pub use list::FleetList;
pub use notice::{FleetCard, FleetHand, NOTICE_BYTES_MAX, reachable, topic};

use std::time::Duration;

/// Longest time between two announcements of a hand, even if nothing changed.
pub const ANNOUNCE_INTERVAL: Duration = Duration::from_millis(600);
/// Silence after which a hand is removed from the list: two notices in a row were lost, or the announcements ended.
pub const GONE_TIMEOUT: Duration = Duration::from_millis(1500);
