//! The joint under the pointer: in its row, or in the drawn hand. Each lights up the other. Lasts one frame.

use crate::hand::Dof;
use egui::{Id, Ui};

/// Where a joint is pointed at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum PointedPlace {
    /// In the rows of the joints.
    Row,
    /// In the drawn hand.
    Hand,
}

/// Says that a joint is under the pointer there.
pub(crate) fn point(ui: &Ui, place: PointedPlace, dof: Dof) {
    let now = ui.ctx().cumulative_pass_nr();
    let id = Id::unique(("pointed", place));
    let before = ui.data_mut(|data| {
        let before = data.get_temp::<(Dof, u64)>(id);
        data.insert_temp(id, (dof, now));
        before
    });
    // What was drawn before this place hears of it in the next frame.
    if before.is_none_or(|(other, at)| other != dof || at + 1 < now) {
        ui.request_repaint();
    }
}

/// The joint that is under the pointer there, in this frame or in the one before.
pub(crate) fn pointed(ui: &Ui, place: PointedPlace) -> Option<Dof> {
    let now = ui.ctx().cumulative_pass_nr();
    let last = ui.data(|data| data.get_temp::<(Dof, u64)>(Id::unique(("pointed", place))));
    last.filter(|(_, at)| at + 1 >= now).map(|(dof, _)| dof)
}
