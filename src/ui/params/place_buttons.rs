//! The buttons of what is done to a hand only under a card. Each opens its card and does nothing else.

use crate::app::action::Action;
use crate::ui::kit::controls;
use crate::ui::kit::controls::Button;
use crate::ui::kit::look::Pane;
use crate::ui::text::cards;
use crate::ui::theme;
use egui::{Id, Rect, Ui};

/// Draws them at the left end of a row, and takes their room from it.
pub(crate) fn left_ui(ui: &mut Ui, row: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let live = pane.state.hand().link.state.is_live();
    let reason = (!live).then(|| look.say(cards::NO_HAND));
    for (text, tip, action) in [
        (
            cards::RESET_ENTRY,
            cards::RESET_ENTRY_TIP,
            Action::FactoryReset,
        ),
        (
            cards::CALIBRATE_ENTRY,
            cards::CALIBRATE_ENTRY_TIP,
            Action::CalibrateForce,
        ),
    ] {
        let width = controls::text_width(ui, look.say(text), theme::body()) + 2.0 * theme::PAD;
        let place = controls::take_left(row, width);
        let button = Button::new(look.say(text), look.say(tip)).disabled(reason);
        if button
            .put(ui, look, place, Id::unique(("guarded", text.en)))
            .clicked()
        {
            pane.actions.push(action);
        }
    }
}
