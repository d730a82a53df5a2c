//! Which hands are there, by what was heard of them. Pure.

use crate::hand::Moment;
use crate::share::fleet::{FleetHand, GONE_TIMEOUT};
use crate::transport::dds::DdsWriterId;
use std::collections::HashMap;

/// Hands that are listed; of more, the newest are left out.
pub const HANDS_MAX: usize = 256;

/// Which hands are there.
#[derive(Debug, Default)]
pub struct FleetBook {
    /// By who tells of it, which is never given twice; with when it was heard last.
    hands: HashMap<DdsWriterId, (FleetHand, Moment)>,
}

impl FleetBook {
    /// Takes in what was heard; true if it changes the list.
    pub fn take(&mut self, from: DdsWriterId, hand: FleetHand, now: Moment) -> bool {
        if self.hands.len() >= HANDS_MAX && !self.hands.contains_key(&from) {
            return false;
        }
        match self.hands.insert(from, (hand, now)) {
            Some((before, _)) => self.hands.get(&from).is_none_or(|(new, _)| *new != before),
            None => true,
        }
    }

    /// Leaves out who is silent; true if that changes the list.
    pub fn sweep(&mut self, now: Moment) -> bool {
        let before = self.hands.len();
        self.hands
            .retain(|_, (_, heard)| now.since(*heard) < GONE_TIMEOUT);
        self.hands.len() != before
    }

    /// The hands by computer and name.
    pub fn list(&self) -> Vec<FleetHand> {
        let mut all: Vec<FleetHand> = self.hands.values().map(|(hand, _)| hand.clone()).collect();
        let key = |hand: &FleetHand| (hand.card.host.clone(), hand.card.name.clone(), hand.card.at);
        all.sort_by_cached_key(key);
        all
    }
}
