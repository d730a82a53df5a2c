//! Table of present hands, from the received announcements. Pure.

use crate::hand::Moment;
use crate::share::fleet::{FleetHand, GONE_TIMEOUT};
use crate::transport::dds::DdsWriterId;
use std::collections::HashMap;

/// Limit of listed hands; beyond it, new ones are left out.
pub const HANDS_MAX: usize = 256;

/// Table of present hands.
#[derive(Debug, Default)]
pub struct FleetBook {
    /// By announcing writer, whose id is never reused; with the time of its last announcement.
    hands: HashMap<DdsWriterId, (FleetHand, Moment)>,
}

impl FleetBook {
    /// Applies an announcement; returns true if it changes the list.
    pub fn apply(&mut self, from: DdsWriterId, hand: FleetHand, now: Moment) -> bool {
        if self.hands.len() >= HANDS_MAX && !self.hands.contains_key(&from) {
            return false;
        }
        match self.hands.insert(from, (hand, now)) {
            Some((before, _)) => self.hands.get(&from).is_none_or(|(new, _)| *new != before),
            None => true,
        }
    }

    /// Removes silent announcers; returns true if that changes the list.
    pub fn sweep(&mut self, now: Moment) -> bool {
        let before = self.hands.len();
        self.hands
            .retain(|_, (_, seen)| now.since(*seen) < GONE_TIMEOUT);
        self.hands.len() != before
    }

    /// Present hands, sorted by computer and name.
    pub fn list(&self) -> Vec<FleetHand> {
        let mut all: Vec<FleetHand> = self.hands.values().map(|(hand, _)| hand.clone()).collect();
        let key = |hand: &FleetHand| (hand.card.host.clone(), hand.card.name.clone(), hand.card.at);
        all.sort_by_cached_key(key);
        all
    }
}
