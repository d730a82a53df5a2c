//! The rooms beside the open view: panels whose border is dragged, that are shut and opened, and the menu that lists them.
//! Where they stand is kept in the settings.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::layout::{Layout, WindowRoom};
use crate::ui::kit::{Button, Pane, Weight};
use crate::ui::text::{Text, exhibit, main, window};
use crate::ui::theme;
use egui::{Frame, Margin, Panel, Popup, Ui};

/// How large a room is, points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoomSize {
    /// As it first opens.
    pub(crate) designed: f32,
    /// What it needs.
    pub(crate) least: f32,
    /// What everything beside it needs.
    pub(crate) rest: f32,
}

/// What the panels need between frames.
#[derive(Debug, Default)]
pub(crate) struct Rooms {
    layout: Layout,
    /// Counts how often the layout was put back: panels with a new id begin as they were designed.
    resets: u32,
}

/// What a room is called.
pub(crate) const fn title(room: WindowRoom) -> Text {
    match room {
        WindowRoom::Joints => main::JOINTS,
        WindowRoom::Side => window::SIDE,
        WindowRoom::Faults => main::TAB_FAULTS,
        WindowRoom::Strip => main::TAB_POSES,
    }
}

impl Rooms {
    /// Begins a frame in which the rooms stand so.
    pub(crate) fn begin(&mut self, layout: Layout) {
        let is_put_back = WindowRoom::ALL.into_iter().any(|room| {
            self.layout.room(room).share.is_some() && layout.room(room).share.is_none()
        });
        self.resets += u32::from(is_put_back);
        self.layout = layout;
    }

    /// A room at its side of what is left of `ui`; nothing where it is shut.
    pub(crate) fn room_ui(
        &self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        (room, size): (WindowRoom, RoomSize),
        add: impl FnOnce(&mut Ui, &mut Pane<'_>),
    ) {
        let salt = (room, self.resets);
        let (panel, gap) = match room {
            WindowRoom::Joints => (Panel::left(salt), Margin { right: GAP, ..NONE }),
            WindowRoom::Side => (Panel::right(salt), Margin { left: GAP, ..NONE }),
            WindowRoom::Faults | WindowRoom::Strip => {
                (Panel::bottom(salt), Margin { top: GAP, ..NONE })
            }
        };
        let is_upright = matches!(room, WindowRoom::Joints | WindowRoom::Side);
        let extent = along(ui.available_size(), is_upright);
        let standing = self.layout.room(room);
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
            let layout = self.layout.toggled(room);
            pane.actions.push(Action::Layout(layout));
        } else if let Some(shown) = shown {
            let now = along(shown.response.rect.size(), is_upright);
            let place = shown.response.rect.expand(2.0 * theme::GAP);
            let let_go = ui.input(|input| {
                let is_drag = input.pointer.any_released() && !input.pointer.any_click();
                is_drag
                    && input
                        .pointer
                        .interact_pos()
                        .is_some_and(|at| place.contains(at))
            });
            if let_go && (now - begun).abs() > 1.0 {
                let standing = standing.with_share(now / extent);
                let layout = self.layout.with(room, standing);
                pane.actions.push(Action::Layout(layout));
            }
        }
    }
}

const NONE: Margin = Margin::ZERO;
/// Space between two rooms.
const GAP: i8 = 8;

fn along(size: egui::Vec2, is_upright: bool) -> f32 {
    if is_upright { size.x } else { size.y }
}

/// The window's menu: which rooms are open, and the layout put back.
pub(crate) fn menu_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let button = Button::said(look, window::MENU)
        .icon(theme::MENU)
        .weight(Weight::Quiet);
    let response = button.ui(ui, look);
    Popup::menu(&response).show(|ui| {
        let before = pane.state.settings.layout;
        let mut after = before;
        for room in WindowRoom::ALL {
            let mut open = !before.room(room).shut;
            if ui.checkbox(&mut open, look.say(title(room))).changed() {
                after = before.toggled(room);
            }
        }
        ui.separator();
        let reset = ui.button(look.say(window::RESET));
        if reset.on_hover_text(look.tip(window::RESET)).clicked() {
            after = before.reset();
        }
        ui.separator();
        for (text, action) in [
            (exhibit::ENTER, ExhibitAction::Enter),
            (exhibit::ENTER_FILE, ExhibitAction::EnterFile),
        ] {
            let button = ui.button(look.say(text));
            if button.on_hover_text(look.tip(text)).clicked() {
                pane.actions.push(Action::Exhibit(action));
            }
        }
        if after != before {
            pane.actions.push(Action::Layout(after));
        }
    });
}
