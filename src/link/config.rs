//! What a link is opened with.

use crate::link::clock::Clock;
use crate::link::poll::plan::PollRates;
use crate::transport::{Dial, Endpoint};
use std::sync::Arc;

/// Called when something new is there, from any thread. Must return at once.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// What a link is opened with.
#[derive(Clone)]
pub struct LinkConfig {
    /// Where the hand is and how it is spoken to.
    pub endpoint: Endpoint,
    /// How often to read what.
    pub rates: PollRates,
    /// The program's clock.
    pub clock: Clock,
    /// How wires are opened; tests put a simulated hand here.
    pub dial: Arc<dyn Dial>,
    /// Called when a record waits.
    pub wake: Wake,
}
