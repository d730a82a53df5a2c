//! Configuration of a link.

use crate::link::clock::Clock;
use crate::link::poll::plan::PollRates;
use crate::transport::{Dial, Endpoint};
use std::sync::Arc;

/// Callback for new records or a new status; called from any thread, and must return at once.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Configuration of a link.
#[derive(Clone)]
pub struct LinkConfig {
    /// Address and protocol of the hand.
    pub endpoint: Endpoint,
    /// Poll rates.
    pub rates: PollRates,
    /// The program's clock.
    pub clock: Clock,
    /// Opens wires; tests use a simulated hand here.
    pub dial: Arc<dyn Dial>,
    /// Called when a record or a new status is available.
    pub wake: Wake,
}
