//! What a source asks of a hand at a moment.

use crate::hand::{Angle, Moment, PerDof};

/// Where a source wants the joints, each time that it says so. No default: absent is not zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Offer {
    /// When it came in, by the program's clock.
    pub at: Moment,
    /// Where each joint should go; `None` leaves it alone.
    pub aims: PerDof<Option<Angle>>,
    /// Whether its dead-man is held; `None` for a source without one.
    pub held: Option<bool>,
    /// The same for targets that are the same to the last bit; `None` for a source that may rightly stand still.
    pub mark: Option<u64>,
}
