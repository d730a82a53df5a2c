//! What the user does with the list of hands.

use crate::app::slot::SlotId;

/// What the user does with the list of hands. None of it moves a hand.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum HandsAction {
    /// Another slot, without a hand so far, that is shown from now on.
    Add,
    /// Show this hand.
    Show(SlotId),
    /// Leave this hand as *Disconnect* does, and take its slot away. The last slot stays.
    Remove(SlotId),
    /// Give this hand a name; empty takes it away.
    Name(SlotId, String),
    /// Hold this hand now, and no other.
    StopOne(SlotId),
    /// Poses and demos go to all hands that are armed, or to the shown one alone.
    PosesForAll(bool),
}
