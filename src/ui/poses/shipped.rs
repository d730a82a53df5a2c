//! Shipped poses and demos: each with its picture, to be started, copied or hidden. Changes none of them.

use crate::app::action::Action;
use crate::poses::edit::LibraryEdit;
use crate::poses::library::EntryId;
use crate::poses::starter::starter;
use crate::ui::hand::tile;
use crate::ui::kit::{Button, Label, Pane, Weight};
use crate::ui::poses::tiles::{pictured, shares, start_ui};
use crate::ui::text::poses;
use crate::ui::theme;
use egui::{Align, Layout, ScrollArea, Ui, UiBuilder, vec2};

/// Size of a tile with its buttons.
const TILE: egui::Vec2 = vec2(150.0, 164.0);

/// Draws all shipped entries, hidden or not.
pub(crate) fn shipped_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    Label::note(pane.look, poses::SHIPPED_ABOUT).wrap().ui(ui);
    let area = ScrollArea::vertical().auto_shrink(false);
    area.id_salt("shipped").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(theme::GAP, theme::GAP);
            for entry in starter().entries() {
                let (_, place) = ui.allocate_space(TILE);
                let builder = UiBuilder::new().id_salt(entry).max_rect(place);
                let down = Layout::top_down_justified(Align::Min);
                tile_ui(&mut ui.new_child(builder.layout(down)), pane, entry);
            }
        });
    });
}

fn tile_ui(ui: &mut Ui, pane: &mut Pane<'_>, entry: EntryId) {
    let (look, state) = (pane.look, pane.state);
    let name = look.entry_name(&state.poses, entry);
    let key = starter().named(entry).map_or("", |names| names.text);
    let hidden = state.settings.hidden_poses.contains(key);
    let overridden = !hidden
        && !state
            .poses
            .shipped(&state.settings.hidden_poses)
            .any(|own| own == entry);
    let place = ui.max_rect();
    ui.painter()
        .rect_filled(place, theme::ROUND, look.palette.sunken);
    ui.spacing_mut().item_spacing.y = theme::STEP;
    let (_, picture) = ui.allocate_space(vec2(place.width(), 88.0));
    if let Some(angles) = pictured(&state.poses, entry) {
        tile::sign_ui(ui, look, picture.shrink(theme::STEP), &shares(&angles));
    }
    let color = if hidden || overridden {
        look.palette.muted
    } else {
        look.palette.text
    };
    ui.vertical_centered(|ui| Label::new(name, color).ui(ui));
    start_ui(ui, pane, entry);
    ui.columns_const(|[left, right]: &mut [Ui; 2]| {
        let is_reaction = matches!(entry, EntryId::Reaction(_));
        let copy = Button::text(look, poses::COPY).weight(Weight::Quiet);
        let copy = copy.disabled_if(is_reaction, look.tr(poses::COPY_REACTION));
        let label = look.tr_with(poses::COPY, name);
        let action = Action::Library(LibraryEdit::Copy(entry));
        copy.named(&label).on_click(left, pane, action);
        let text = if hidden { poses::SHOW } else { poses::HIDE };
        let label = look.tr_with(text, name);
        let hide = Button::text(look, text).weight(Weight::Quiet);
        let hide = hide.disabled_if(overridden, look.tr(poses::OVERRIDDEN));
        hide.named(&label)
            .on_click(right, pane, Action::HideShipped(key.to_owned(), !hidden));
    });
}
