//! What besides the window may move the hand, and who reads it.

use crate::ui::inputs::cards::SourceCards;
use crate::ui::inputs::owner::owner_ui;
use crate::ui::inputs::pad_card::PadCard;
use crate::ui::kit::{self, Pane};
use crate::ui::theme;
use egui::{Panel, ScrollArea, Ui};

/// A view as wide as this has the gamepad beside the rest.
const WIDE: f32 = 1160.0;
/// Width of what is beside the gamepad.
const SOURCES: f32 = 420.0;

/// What was typed and chosen.
#[derive(Debug, Default)]
pub(crate) struct InputsView {
    cards: SourceCards,
    pad: PadCard,
}

impl InputsView {
    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        if ui.available_width() < WIDE {
            scroll_ui(ui, "inputs", |ui| {
                owner_ui(ui, pane);
                self.cards.ui(ui, pane);
                self.pad.ui(ui, pane);
            });
            return;
        }
        let sources = Panel::left("sources");
        kit::bare(sources, SOURCES, theme::GAP_RIGHT).show(ui, |ui| {
            scroll_ui(ui, "inputs", |ui| {
                owner_ui(ui, pane);
                self.cards.ui(ui, pane);
            });
        });
        scroll_ui(ui, "pad", |ui| self.pad.ui(ui, pane));
    }
}

fn scroll_ui(ui: &mut Ui, salt: &str, add: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical()
        .id_salt(salt)
        .auto_shrink(false)
        .show(ui, add);
}
