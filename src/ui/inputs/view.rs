//! The view of inputs that may move the hand, and of readers of its data.

use crate::ui::inputs::cards::SourceCards;
use crate::ui::inputs::owner::owner_ui;
use crate::ui::kit::Pane;
use crate::ui::theme;
use egui::Ui;

/// View state.
#[derive(Debug, Default)]
pub(crate) struct InputsView {
    cards: SourceCards,
}

impl InputsView {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        ui.spacing_mut().item_spacing.y = theme::GAP;
        owner_ui(ui, pane);
        self.cards.ui(ui, pane);
    }
}
