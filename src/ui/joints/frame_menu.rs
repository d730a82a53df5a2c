//! The frame behind a control: on the secondary button, the bytes it sends on each wire, to copy. Sends nothing.

use crate::hand::HandCommand;
use crate::link::traffic::FrameFormat;
use crate::link::traffic::compose::{FrameSnippet, SnippetFormat};
use crate::ui::kit::Pane;
use crate::ui::text::main;
use crate::ui::theme;
use egui::{Id, RichText, Ui};

/// Width of the menu.
const WIDTH: f32 = 440.0;

/// Gives the control with this id its menu. `command` is what the control would send as it stands.
pub(crate) fn frame_menu_ui(ui: &Ui, pane: &Pane<'_>, id: Id, command: &HandCommand) {
    let Some(response) = ui.ctx().read_response(id) else {
        return;
    };
    egui::Popup::context_menu(&response)
        .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(WIDTH);
            menu_ui(ui, pane, id.with("wire"), command);
        });
}

fn menu_ui(ui: &mut Ui, pane: &Pane<'_>, id: Id, command: &HandCommand) {
    let look = pane.look;
    let endpoint = pane.state.hand().endpoint.as_ref();
    let current = endpoint.map_or(FrameFormat::Rs485, FrameFormat::of);
    let chosen = ui.data(|data| data.get_temp::<FrameFormat>(id));
    let mut wire = chosen.unwrap_or(current);
    ui.label(RichText::new(look.say(main::FRAME_TITLE)).font(theme::title()));
    ui.horizontal(|ui| {
        for each in FrameFormat::ALL {
            ui.selectable_value(&mut wire, each, each.name());
        }
    });
    ui.data_mut(|data| data.insert_temp(id, wire));
    let snippet = FrameSnippet::new(command, wire, endpoint);
    let hex = snippet.text(SnippetFormat::Hex);
    egui::Frame::new()
        .fill(look.palette.sunken)
        .inner_margin(theme::GAP)
        .corner_radius(theme::ROUND_SMALL)
        .show(ui, |ui| {
            ui.set_width(WIDTH - 2.0 * theme::GAP);
            ui.label(RichText::new(&hex).font(theme::number()));
        });
    ui.horizontal(|ui| {
        ui.label(look.say(main::FRAME_COPY));
        for form in SnippetFormat::ALL {
            if ui.button(form.name()).clicked() {
                ui.ctx().copy_text(snippet.text(form));
            }
        }
    });
    let hint = RichText::new(look.say(main::FRAME_HINT)).font(theme::small());
    ui.label(hint.color(look.palette.muted));
}
