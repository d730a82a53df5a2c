//! Identification of one of several hands: its slot in the window and its name.

use crate::transport::Endpoint;
use std::sync::Arc;

/// Slot of a hand in the window, while it is listed. IDs are not reused within a run of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SlotId(u32);

impl SlotId {
    /// The next ID.
    pub(crate) const fn next(self) -> Self {
        Self(self.0.saturating_add(1))
    }
}

/// Slot and name of a hand: the user-given name, else the address.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HandLabel {
    pub slot: SlotId,
    /// Empty for a slot without a hand.
    pub name: Arc<str>,
}

/// Name of an unnamed hand: its address.
pub(crate) fn place_name(endpoint: &Endpoint) -> String {
    match endpoint {
        Endpoint::Sim { .. } => endpoint.place_and_id().0,
        Endpoint::Can { id, .. } => format!("{} id {id}", endpoint.place()),
        _ => endpoint.place(),
    }
}
