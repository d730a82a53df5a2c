//! A caption and what stands beside it, and the drawer for experts.

use crate::ui::kit::{Label, Look};
use crate::ui::text::panels;
use crate::ui::theme;
use egui::{Align, CollapsingHeader, Layout, Ui, vec2};

/// Width of the captions.
const CAPTION: f32 = 104.0;

/// A drawer for what hardly anybody needs.
pub(crate) fn expert_ui(ui: &mut Ui, look: Look, add: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(look.say(panels::EXPERT)).show_unindented(ui, add);
}

/// A caption, and what stands beside it.
pub(crate) fn row_ui<R>(
    ui: &mut Ui,
    look: Look,
    caption: &str,
    add: impl FnOnce(&mut Ui) -> R,
) -> R {
    ui.horizontal(|ui| {
        let left = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(CAPTION, theme::CONTROL), left, |ui| {
            ui.set_min_size(vec2(CAPTION, theme::CONTROL));
            Label::new(caption, look.palette.muted).ui(ui);
        });
        add(ui)
    })
    .inner
}
