//! One hand behind several servers, with the clock they share. No protocol.

use crate::hand::Moment;
use crate::sim::hand::SimHand;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::time::Instant;

/// A hand shared by several servers. Each lock lasts for one call.
#[derive(Debug, Clone)]
pub struct SharedHand {
    hand: Arc<Mutex<SimHand>>,
    epoch: Instant,
}

impl SharedHand {
    /// True while another handle to the same hand exists.
    pub fn is_shared(&self) -> bool {
        Arc::strong_count(&self.hand) > 1
    }

    /// Shares a hand whose clock starts at `epoch`, the instant of [`Moment::ZERO`].
    pub fn new(hand: SimHand, epoch: Instant) -> Self {
        Self {
            hand: Arc::new(Mutex::new(hand)),
            epoch,
        }
    }

    /// Current time of the hand.
    pub fn now(&self) -> Moment {
        Moment::from_duration(self.epoch.elapsed())
    }

    /// Converts a moment to an instant, never earlier than the moment.
    pub fn instant(&self, moment: Moment) -> Instant {
        self.epoch + moment.since(Moment::ZERO)
    }

    /// Calls `act` with the hand, at its current time.
    pub fn with<T>(&self, act: impl FnOnce(&mut SimHand, Moment) -> T) -> T {
        // A panic in another caller leaves the hand consistent: each call completes its own changes.
        let mut hand = self.hand.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut hand, self.now())
    }
}
