//! The window's menu at the right end of the tabs: rooms shut and opened, the layout put back. Moves nothing.

use crate::app::layout::Room;
use crate::ui::kit::border::{ask, title};
use crate::ui::kit::controls::{Button, Weight};
use crate::ui::kit::look::Pane;
use crate::ui::text::layout;
use crate::ui::theme;
use crate::ui::window::rooms::toggled;
use egui::{Id, Rect, Ui};

/// All rooms that can be shut.
const ROOMS: [Room; 5] = [
    Room::Joints,
    Room::Side,
    Room::Tips,
    Room::Faults,
    Room::Strip,
];

/// Draws the button, and the menu while it is open.
pub(crate) fn menu_button_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let name = look.say(layout::MENU);
    let button = Button::new(name, look.say(layout::MENU_TIP))
        .icon(theme::MENU)
        .weight(Weight::Quiet);
    let response = button.put(ui, look, rect, Id::unique("window menu"));
    egui::Popup::menu(&response).show(|ui| {
        ui.set_width(theme::MENU_WIDTH);
        rooms_ui(ui, pane);
        ui.separator();
        let reset = ui.button(look.say(layout::RESET));
        if reset.on_hover_text(look.say(layout::RESET_TIP)).clicked() {
            ask(pane, pane.state.settings.layout.reset());
        }
    });
}

fn rooms_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let layout = pane.state.settings.layout;
    for room in ROOMS {
        let mut open = !layout.room(room).shut;
        if ui.checkbox(&mut open, pane.look.say(title(room))).changed() {
            ask(pane, toggled(&layout, room));
        }
    }
}
