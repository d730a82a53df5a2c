//! The view of inputs that may move the hand, and of readers of its data.

use crate::ui::inputs::cards::SourceCards;
use crate::ui::inputs::owner::owner_ui;
use crate::ui::inputs::pad_card::PadCard;
use crate::ui::kit::Pane;
use crate::ui::theme;
use egui::{ScrollArea, Ui};

/// View state.
#[derive(Debug, Default)]
pub(crate) struct InputsView {
    cards: SourceCards,
    pad: PadCard,
}

impl InputsView {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = theme::GAP;
            owner_ui(ui, pane);
            self.cards.ui(ui, pane);
            self.pad.ui(ui, pane);
        });
    }
}
