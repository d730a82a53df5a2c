//! The fleet: the hands that Handscopes share, told over DDS by those that share them and listed by those that look. Which of them are
//! there DDS finds out; a hand's link does nothing for it.

mod book;
mod followers;
mod list;
mod notice;
mod teller;
#[cfg(test)]
mod tests;

pub use book::{FleetBook, HANDS_MAX};
pub use followers::OtherFollowers;
pub use list::FleetList;
pub use notice::{FleetCard, FleetHand, NOTICE_BYTES_MAX, reachable, topic};
pub use teller::{FleetTeller, host};

use std::time::Duration;

/// A hand is told again after so long at the most, also if nothing changed.
pub const ANNOUNCE_INTERVAL: Duration = Duration::from_millis(600);
/// A hand of which nothing was heard for so long is no longer listed: two notices in a row were lost, or nobody tells.
pub const GONE_TIMEOUT: Duration = Duration::from_millis(1500);
