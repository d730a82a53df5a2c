//! A caption and what stands beside it, and the drawer for experts.

use crate::ui::kit::{self, Label, Look};
use crate::ui::text::panels;
use crate::ui::theme;
use egui::{CollapsingHeader, Ui, vec2};

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
        kit::cell_ui(ui, vec2(104.0, theme::CONTROL), |ui| {
            Label::new(caption, look.palette.muted).ui(ui);
        });
        add(ui)
    })
    .inner
}
