//! What every control of a gamepad does, as a list in which the user changes it.

use crate::inputs::pad::{PadAction, PadControl, PadMap};
use crate::ui::inputs::pad_picture::PadShown;
use crate::ui::kit::{Label, Look, choose_ui};
use crate::ui::text::inputs;
use crate::ui::theme;
use egui::Ui;

/// Width of the name of a control.
const NAME: f32 = 160.0;
/// Width of what it does, as far as words do not need more.
const ACTION: f32 = 180.0;

/// Draws a row for each control; the map with what was changed, if something was.
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
            Label::new(look.say(inputs::control(control)), color).cell_ui(ui, NAME);
            action_ui(ui, look, control, shown)
        });
        changed = changed.or(row.inner);
    }
    changed
}

/// What one control does; the map with another action for it, if one was chosen.
fn action_ui(ui: &mut Ui, look: Look, control: PadControl, shown: &PadShown<'_>) -> Option<PadMap> {
    let before = shown.map.action(control);
    let plain = PadAction::choices(control.kind()).iter().cloned();
    let poses = shown.poses.iter();
    let poses = poses.map(|pose| PadAction::Pose(pose.name.clone()));
    let poses = poses.filter(|pose| pose.fits(control.kind()));
    let mut all: Vec<PadAction> = plain.chain(poses).collect();
    // A pose that is not in the library any more.
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
    let name = look.say(inputs::control(control));
    let chosen = ui.add_enabled_ui(!before.is_single(), |ui| {
        choose_ui(ui, name, &mut action, &choices)
    });
    chosen
        .response
        .on_disabled_hover_text(look.say(inputs::SINGLE));
    if chosen.inner {
        shown.map.with(control, action).ok()
    } else {
        None
    }
}
