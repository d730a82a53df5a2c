//! Which of several hands: its slot in the window, and what it is called there.

use crate::transport::Endpoint;
use std::sync::Arc;

/// The slot of a hand in the window, for as long as it is there. None is given twice in one run of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SlotId(u32);

impl SlotId {
    /// The one that is given next.
    pub(crate) const fn next(self) -> Self {
        Self(self.0.saturating_add(1))
    }
}

/// Which hand, and what it is called: the user's name for it, else where it is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HandLabel {
    pub slot: SlotId,
    /// Empty for a slot without a hand.
    pub name: Arc<str>,
}

/// What a hand without a name is called: where it is.
pub(crate) fn place_name(endpoint: &Endpoint) -> String {
    match endpoint {
        Endpoint::Sim { .. } => endpoint.place_and_id().0,
        Endpoint::Can { id, .. } => format!("{} id {id}", endpoint.place()),
        _ => endpoint.place(),
    }
}
