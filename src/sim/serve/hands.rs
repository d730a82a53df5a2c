//! Several hands on one wire: all of them hear everything, each answers only its own id. No protocol.

use crate::hand::Moment;
use crate::sim::hand::SimHand;
use crate::sim::serve::shared::SharedHand;

/// The unit ids of Modbus TCP that mean "whoever is at this address": the manual's (2.5) and the standard's.
const ANY_UNITS: [u8; 2] = [255, 0];

/// The hands on one wire, at least one; their order matters where an address names no id.
#[derive(Debug, Clone)]
pub struct SimHands {
    first: SharedHand,
    others: Vec<SharedHand>,
}

impl From<SharedHand> for SimHands {
    fn from(hand: SharedHand) -> Self {
        Self::new(hand, Vec::new())
    }
}

impl SimHands {
    /// One hand and those beside it.
    pub const fn new(first: SharedHand, others: Vec<SharedHand>) -> Self {
        Self { first, others }
    }

    /// All of them, the first one first.
    pub fn iter(&self) -> impl Iterator<Item = &SharedHand> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// The one that a Modbus TCP unit id means. A hand that is alone answers to every unit; of several, 255 and 0 mean
    /// the first, any other unit the hand of that id.
    pub(crate) fn unit(&self, unit: u8) -> Option<&SharedHand> {
        if self.others.is_empty() || ANY_UNITS.contains(&unit) {
            return Some(&self.first);
        }
        self.iter()
            .find(|hand| hand.with(|hand, _| hand.id()) == unit)
    }

    /// The one that is meant where none is named.
    pub(crate) const fn first(&self) -> &SharedHand {
        &self.first
    }

    /// Does something with each hand, at its time now.
    pub fn with_each(&self, mut act: impl FnMut(&mut SimHand, Moment)) {
        for hand in self.iter() {
            hand.with(&mut act);
        }
    }
}
