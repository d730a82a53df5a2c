//! Actions of all gamepad controls, as a list in which the user changes them.

use crate::inputs::pad::{PadAction, PadControl, PadMap};
use crate::ui::inputs::pad_picture::PadShown;
use crate::ui::kit::{Label, Look, choose_ui};
use crate::ui::text::inputs;
use crate::ui::theme;
use egui::Ui;

/// Width of a control's name.
const NAME: f32 = 160.0;
/// Minimum width of an action.
const ACTION: f32 = 180.0;

/// Draws a row for each control. Returns the map with a change, if the user made one.
pub(crate) fn pad_table_ui(ui: &mut Ui, look: Look, shown: &PadShown<'_>) -> Option<PadMap> {
    let mut changed = None;
    ui.spacing_mut().combo_width = ACTION;
    for control in PadControl::ALL {
        let row = ui.horizontal(|ui| {
            ui.set_min_height(theme::CONTROL);
            let color = if shown.chosen == Some(control) {
                look.palette.accent
            } else {
                look.palette.text
            };
            Label::new(look.tr(inputs::control(control)), color).cell_ui(ui, NAME);
            action_ui(ui, look, control, shown)
        });
        changed = changed.or(row.inner);
    }
    changed
}

/// Draws the action of one control. Returns the map with its new action, if the user chose one.
fn action_ui(ui: &mut Ui, look: Look, control: PadControl, shown: &PadShown<'_>) -> Option<PadMap> {
    let before = shown.map.action(control);
    let plain = PadAction::choices(control.kind()).iter().cloned();
    let poses = shown.poses.iter();
    let poses = poses.map(|pose| PadAction::Pose(pose.name.clone()));
    let poses = poses.filter(|pose| pose.fits(control.kind()));
    let mut all: Vec<PadAction> = plain.chain(poses).collect();
    // A pose that is no longer in the library.
    if !all.contains(before) {
        all.push(before.clone());
    }
    let all = all.into_iter();
    let choices = all.map(|action| {
        let words = shown.does(look, &action);
        (action, words)
    });
    let choices: Vec<(PadAction, String)> = choices.collect();
    let mut action = before.clone();
    let name = look.tr(inputs::control(control));
    let chosen = ui.add_enabled_ui(!before.is_single(), |ui| {
        choose_ui(ui, name, &mut action, &choices)
    });
    chosen
        .response
        .on_disabled_hover_text(look.tr(inputs::SINGLE));
    if chosen.inner {
        shown.map.with(control, action).ok()
    } else {
        None
    }
}
