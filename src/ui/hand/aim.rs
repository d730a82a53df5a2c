//! Sets targets of joints, from a joint's track or by dragging the drawn hand: one rule for both.

use crate::app::action::Action;
use crate::hand::gap::Gap;
use crate::hand::{Angle, Dof};
use crate::ui::kit::Pane;
use crate::ui::text::main;
use egui::{Id, Ui};

/// Fingers that move together when they are linked. The thumb is not among them: it moves differently.
const LINKED: [Dof; 4] = [Dof::Little, Dof::Ring, Dof::Middle, Dof::Index];

/// Reason why no target can be set for this joint now; `None` if it is possible.
pub(crate) fn refusal(pane: &Pane<'_>, dof: Dof) -> Option<&'static str> {
    let locked = pane.hand().controls.joints[dof].locked;
    let locked = locked.then(|| pane.look.tr(main::LOCKED));
    pane.unready().or(locked)
}

/// Sets a joint's target. Linked fingers change theirs by the same amount, each from its own target.
pub(crate) fn send(pane: &mut Pane<'_>, dof: Dof, angle: Angle, linked: bool) {
    let joints = pane.hand().controls.joints;
    pane.actions.push(Action::Target(dof, angle));
    let by = joints[dof].target.map(|old| angle.get() - old.get());
    let Some(by) = by.filter(|_| linked && LINKED.contains(&dof)) else {
        return;
    };
    for other in LINKED.into_iter().filter(|other| *other != dof) {
        if let Some(target) = joints[other].target.filter(|_| !joints[other].locked) {
            let angle = Angle::nearest(target.get().saturating_add(by));
            pane.actions.push(Action::Target(other, angle));
        }
    }
}

/// Marks the fingers as linked for this frame. Called while the link switch is drawn and on.
pub(crate) fn link(ui: &Ui) {
    let now = ui.ctx().cumulative_pass_nr();
    ui.data_mut(|data| data.insert_temp(Id::unique("fingers linked"), now));
}

/// True if the link switch was drawn and on in this frame or the one before.
pub(crate) fn is_linked(ui: &Ui) -> bool {
    let now = ui.ctx().cumulative_pass_nr();
    let last = ui.data(|data| data.get_temp::<u64>(Id::unique("fingers linked")));
    last.is_some_and(|at| at + 1 >= now)
}

/// Requests a preview of a gap for this frame.
pub(crate) fn wish(ui: &Ui, gap: Gap) {
    let now = ui.ctx().cumulative_pass_nr();
    ui.data_mut(|data| data.insert_temp(Id::unique("gap wished"), (now, gap)));
}

/// Gap to preview; `None` when its control was not drawn in this frame or the one before.
pub(crate) fn wished(ui: &Ui) -> Option<Gap> {
    let now = ui.ctx().cumulative_pass_nr();
    let wish = ui.data(|data| data.get_temp::<(u64, Gap)>(Id::unique("gap wished")));
    wish.filter(|(at, _)| at + 1 >= now).map(|(_, gap)| gap)
}
