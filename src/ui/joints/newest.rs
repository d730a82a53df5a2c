//! What a hand said last of one joint.

use crate::app::hand::Freshness;
use crate::hand::{Dof, PerDof, Timed};
use crate::ui::kit::look::Pane;

/// The newest value of one joint, and how fresh it is.
pub(crate) fn newest<T: Copy>(
    pane: &Pane<'_>,
    dof: Dof,
    group: Option<Timed<PerDof<T>>>,
) -> (Option<T>, Freshness) {
    let freshness = pane.freshness(group.map(|group| group.asked));
    (group.map(|group| group.value[dof]), freshness)
}
