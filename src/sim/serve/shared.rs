//! One hand behind several servers, with the clock they share. No protocol.

use crate::hand::Moment;
use crate::sim::hand::SimHand;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::time::Instant;

/// A hand that several servers answer for. Locks last for one call.
#[derive(Debug, Clone)]
pub struct SharedHand {
    hand: Arc<Mutex<SimHand>>,
    epoch: Instant,
}

impl SharedHand {
    /// True while there is another handle to the same hand.
    pub fn is_shared(&self) -> bool {
        Arc::strong_count(&self.hand) > 1
    }

    /// Switches the hand's clock on at `epoch`, the instant of [`Moment::ZERO`].
    pub fn new(hand: SimHand, epoch: Instant) -> Self {
        Self {
            hand: Arc::new(Mutex::new(hand)),
            epoch,
        }
    }

    /// The hand's time now.
    pub fn now(&self) -> Moment {
        Moment::from_duration(self.epoch.elapsed())
    }

    /// The instant of a moment, never before it.
    pub fn instant(&self, moment: Moment) -> Instant {
        self.epoch + moment.since(Moment::ZERO)
    }

    /// Does something with the hand, at its time now.
    pub fn with<T>(&self, act: impl FnOnce(&mut SimHand, Moment) -> T) -> T {
        // A hand whose user panicked still is a whole hand: each call leaves it so.
        let mut hand = self.hand.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut hand, self.now())
    }
}
