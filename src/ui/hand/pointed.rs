//! The joint under the pointer, in its row or in the drawn hand. Each highlights the other. Lasts one frame.

use crate::hand::Dof;
use egui::{Id, Ui};

/// Part of the window in which a joint is hovered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum PointedPlace {
    /// The joint's row.
    Row,
    /// The drawn hand.
    Hand,
}

/// Marks a joint as hovered in this frame.
pub(crate) fn point(ui: &Ui, place: PointedPlace, dof: Dof) {
    let now = ui.ctx().cumulative_pass_nr();
    let id = Id::unique(("pointed", place));
    let before = ui.data_mut(|data| {
        let before = data.get_temp::<(Dof, u64)>(id);
        data.insert_temp(id, (dof, now));
        before
    });
    // Parts drawn earlier in this frame see it in the next one.
    if before.is_none_or(|(other, at)| other != dof || at + 1 < now) {
        ui.request_repaint();
    }
}

/// Joint hovered in that part, in this frame or the one before.
pub(crate) fn pointed(ui: &Ui, place: PointedPlace) -> Option<Dof> {
    let now = ui.ctx().cumulative_pass_nr();
    let last = ui.data(|data| data.get_temp::<(Dof, u64)>(Id::unique(("pointed", place))));
    last.filter(|(_, at)| at + 1 >= now).map(|(dof, _)| dof)
}
