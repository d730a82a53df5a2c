//! Several hands on one wire: all receive everything, each answers only its own id. No protocol.

use crate::hand::Moment;
use crate::sim::hand::SimHand;
use crate::sim::serve::shared::SharedHand;

/// Modbus TCP unit ids that mean any unit at this address: the manual's (2.5) and the standard's.
const ANY_UNITS: [u8; 2] = [255, 0];

/// The hands on one wire, at least one; the order matters where an address names no id.
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
    /// Creates a wire with `first` and further hands.
    pub const fn new(first: SharedHand, others: Vec<SharedHand>) -> Self {
        Self { first, others }
    }

    /// Iterates over all hands, `first` first.
    pub fn iter(&self) -> impl Iterator<Item = &SharedHand> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// Returns the hand that a Modbus TCP unit id means. A single hand answers to every unit; of several, 255 and 0 mean
    /// the first, any other unit the hand with that id.
    pub(crate) fn unit(&self, unit: u8) -> Option<&SharedHand> {
        if self.others.is_empty() || ANY_UNITS.contains(&unit) {
            return Some(&self.first);
        }
        self.iter()
            .find(|hand| hand.with(|hand, _| hand.id()) == unit)
    }

    /// The hand used where no id is given.
    pub(crate) const fn first(&self) -> &SharedHand {
        &self.first
    }

    /// Calls `act` on each hand, at its current time.
    pub fn with_each(&self, mut act: impl FnMut(&mut SimHand, Moment)) {
        for hand in self.iter() {
            hand.with(&mut act);
        }
    }
}
