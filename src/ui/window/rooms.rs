//! Panels beside the open view, which the user resizes, closes and opens, and the menu that lists them. Their layout is
//! stored in the settings.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::layout::{RoomLayouts, WindowRoom};
use crate::app::settings::Language;
use crate::ui::kit::{self, Button, Pane, ViewRequest, Weight};
use crate::ui::text::{Text, exhibit, main, window};
use crate::ui::theme;
use egui::{Frame, Panel, Popup, Ui};

/// Size of a panel, in points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoomSize {
    pub(crate) room: WindowRoom,
    /// Initial size.
    pub(crate) designed: f32,
    /// Minimum size.
    pub(crate) least: f32,
    /// Space that everything beside it needs.
    pub(crate) rest: f32,
}

/// View state of the panels.
#[derive(Debug, Default)]
pub(crate) struct Rooms {
    layouts: RoomLayouts,
    /// Counts layout resets: panels with a new id start at their initial size.
    resets: u32,
}

/// Title of a panel.
const fn title(room: WindowRoom) -> Text {
    match room {
        WindowRoom::Joints => main::JOINTS,
        WindowRoom::Stage => window::STAGE,
        WindowRoom::Strip => main::TAB_POSES,
    }
}

impl Rooms {
    /// Begins a frame with these layouts.
    pub(crate) fn begin(&mut self, layouts: RoomLayouts) {
        let is_put_back = WindowRoom::ALL.into_iter().any(|room| {
            self.layouts.room(room).share.is_some() && layouts.room(room).share.is_none()
        });
        self.resets += u32::from(is_put_back);
        self.layouts = layouts;
    }

    /// True if the panel is collapsed to its name.
    pub(crate) const fn is_shut(&self, room: WindowRoom) -> bool {
        self.layouts.room(room).shut
    }

    /// Draws a panel at its side of the rest of `ui`; its content is hidden while it is closed.
    pub(crate) fn room_ui(
        &self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        size: RoomSize,
        add: impl FnOnce(&mut Ui, &mut Pane<'_>),
    ) {
        let room = size.room;
        let is_upright = room != WindowRoom::Strip;
        let extent = along(ui.available_size(), is_upright);
        let standing = self.layouts.room(room);
        // In a window of another size, with another share, or beside a view of another width, the panel starts anew: the limits
        // of one view leave no trace in the next.
        let sizes = [extent, size.rest, size.designed].map(f32::to_bits);
        let share = standing.share.map(f32::to_bits);
        let salt = (room, self.resets, share, sizes);
        let (panel, gap) = if is_upright {
            (Panel::left(salt), theme::GAP_RIGHT)
        } else {
            (Panel::bottom(salt), theme::GAP_TOP)
        };
        let most = (extent - size.rest).max(size.least);
        let wanted = standing.share.map_or(size.designed, |share| share * extent);
        let begun = wanted.clamp(size.least, most).round();
        let mut open = !standing.shut;
        let shown = panel
            .frame(Frame::new().inner_margin(gap))
            .show_separator_line(false)
            .default_size(begun)
            .size_range(size.least..=most)
            .show_collapsible(ui, &mut open, |ui| {
                ui.take_available_space();
                add(ui, pane);
            });
        if open == standing.shut {
            pane.lay_out(ui, self.layouts.toggled(room));
        } else if let Some(shown) = shown {
            let now = along(shown.response.rect.size(), is_upright);
            let place = shown.response.rect.expand(2.0 * theme::GAP);
            let released = ui.input(|input| {
                let pointer = &input.pointer;
                let is_drag = pointer.any_released() && !pointer.any_click();
                let at = pointer.interact_pos().filter(|_| is_drag);
                at.is_some_and(|at| place.contains(at))
            });
            if released && (now - begun).abs() > 1.0 {
                let standing = standing.with_share(now / extent);
                pane.lay_out(ui, self.layouts.with(room, standing));
            }
        }
    }
}

fn along(size: egui::Vec2, is_upright: bool) -> f32 {
    if is_upright { size.x } else { size.y }
}

/// The window's menu: open panels, colours, language, keys, exhibitions.
pub(crate) fn menu_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let button = Button::text(look, window::MENU)
        .icon(theme::MENU)
        .weight(Weight::Quiet);
    let response = button.ui(ui, look);
    Popup::menu(&response).show(|ui| {
        let before = pane.layouts(ui);
        let mut after = before;
        for room in WindowRoom::ALL {
            let mut open = !before.room(room).shut;
            if ui.checkbox(&mut open, look.tr(title(room))).changed() {
                after = before.toggled(room);
            }
        }
        if kit::entry_ui(ui, look, window::RESET) {
            after = RoomLayouts::default();
        }
        if after != before {
            pane.lay_out(ui, after);
        }
        ui.separator();
        let (theme, language) = (pane.state.settings.theme, pane.state.settings.language);
        if kit::entry_ui(ui, look, main::THEME) {
            pane.actions.push(Action::Theme(theme.other()));
        }
        let other = match language {
            Language::En => "中文",
            Language::Zh => "English",
        };
        let button = ui.button(other);
        let tip = look.tr(window::KEY_LANGUAGE);
        if button.on_hover_text(tip).clicked() {
            pane.actions.push(Action::Language(language.other()));
        }
        ui.separator();
        for (text, opens) in [
            (window::COMMANDS, ViewRequest::Palette),
            (window::KEYS, ViewRequest::Keys),
        ] {
            if kit::entry_ui(ui, look, text) {
                pane.open(opens);
            }
        }
        ui.separator();
        for (text, action) in [
            (exhibit::ENTER, ExhibitAction::Enter),
            (exhibit::ENTER_FILE, ExhibitAction::EnterFile),
        ] {
            if kit::entry_ui(ui, look, text) {
                pane.actions.push(Action::Exhibit(action));
            }
        }
    });
}
