//! How single bytes stand in Modbus words: as the hand shows it, or as a person says. Writes nothing.

use crate::transport::Packing;
use crate::ui::kit::controls::{Button, Label, take_left, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, quirks};
use crate::ui::theme;
use egui::{Id, Rect, Ui};

/// Height that the row takes.
pub(crate) const HEIGHT: f32 = theme::LINE_HIGH + theme::GAP;

/// Draws the caption and what is chosen, which opens the other choices.
pub(crate) fn packing_ui(
    ui: &mut Ui,
    body: &mut Rect,
    pane: &Pane<'_>,
    caption_width: f32,
    chosen: &mut Option<Packing>,
) {
    let look = pane.look;
    let mut row = take_top(body, theme::LINE_HIGH);
    let caption = look.say(quirks::PACKING);
    let left = take_left(&mut row, caption_width);
    Label::new(caption, look.palette.muted).put(ui, left);
    let value = look.say(choice(*chosen));
    let name = format!("{caption}: {value}");
    let button = Button::new(value, look.say(quirks::PACKING_TIP)).named(&name);
    let response = button.put(ui, look, row, Id::unique("packing"));
    egui::Popup::menu(&response).width(row.width()).show(|ui| {
        for each in [None].into_iter().chain(Packing::ALL.map(Some)) {
            let is_chosen = each == *chosen;
            if ui.radio(is_chosen, look.say(choice(each))).clicked() {
                *chosen = each;
                egui::Popup::close_all(ui.ctx());
            }
        }
    });
}

const fn choice(packing: Option<Packing>) -> Text {
    match packing {
        None => quirks::AS_FOUND,
        Some(Packing::Low) => quirks::LOW,
        Some(Packing::High) => quirks::HIGH,
        Some(Packing::One) => quirks::ONE,
    }
}
