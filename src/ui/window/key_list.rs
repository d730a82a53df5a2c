//! The list of all keys, over the window. It covers neither STOP nor the top bar, and stops nothing itself.

use crate::ui::kit::{self, Button, Label, Look, Weight};
use crate::ui::text::{Text, main, window};
use crate::ui::theme;
use crate::ui::window::keys::{COMMAND_NAME, ROWS, Wish, ZOOM};
use egui::{Align2, Frame, Grid, Id, Margin, Rect, Stroke, Ui, Window};

/// The list, shown or hidden.
#[derive(Debug, Default)]
pub(crate) struct KeyList {
    open: bool,
    /// Opened in this frame: the press that opened it must not close it again.
    fresh: bool,
}

impl KeyList {
    /// Shows or hides the list.
    pub(crate) fn toggle(&mut self) {
        self.open = !self.open;
        self.fresh = self.open;
    }

    /// True while it is shown.
    pub(crate) const fn is_open(&self) -> bool {
        self.open
    }

    /// Hides the list.
    pub(crate) fn hide(&mut self) {
        self.open = false;
    }

    /// Draws it in the middle of `place`, if it is shown. A click beside it hides it.
    pub(crate) fn ui(&mut self, ui: &Ui, place: Rect, look: Look) {
        if !self.open {
            return;
        }
        let edge = Stroke::new(theme::LINE, look.palette.accent);
        let frame = Frame::window(ui.style()).stroke(edge);
        let window = Window::new(look.tr(window::KEYS))
            .id(Id::unique("key list"))
            .title_bar(false)
            .resizable(false)
            .frame(frame)
            .pivot(Align2::CENTER_CENTER)
            .fixed_pos(place.center())
            .constrain_to(place);
        let shown = window.show(ui.ctx(), |ui| {
            ui.set_width((place.width() - 4.0 * theme::PAD).min(880.0));
            list_ui(ui, look)
        });
        let Some(shown) = shown else { return };
        let beside = shown.response.clicked_elsewhere();
        if shown.inner == Some(true) || beside && !self.fresh {
            self.open = false;
        }
        self.fresh = false;
    }
}

/// Groups of the list, by column.
const COLUMNS: [&[Text]; 3] = [
    &[window::KEY_MOTION, window::KEY_MEASURING],
    &[window::KEY_JOINTS, window::KEY_HANDS],
    &[window::KEY_WINDOW],
];

/// Keys of a group, with their descriptions.
fn rows(group: Text) -> Vec<(String, Text)> {
    let wishes = ROWS.iter().map(|row| row.wish);
    let mut wishes: Vec<Wish> = wishes.filter(|wish| wish.group() == group).collect();
    wishes.dedup();
    // The first hand's key represents those of all hands.
    wishes.retain(|wish| !matches!(wish, Wish::Hand(1..)));
    let rows = wishes.into_iter().map(|wish| (wish.keys(), wish.words()));
    let mut rows: Vec<(String, Text)> = rows.collect();
    if group == window::KEY_MOTION {
        rows.push(("Shift+F".to_owned(), window::KEY_ENTRY));
    }
    if group == window::KEY_WINDOW {
        rows.extend(ZOOM.map(|(key, words)| (format!("{COMMAND_NAME}+{key}"), words)));
    }
    rows
}

/// Draws the list. True if the user closes it.
fn list_ui(ui: &mut Ui, look: Look) -> bool {
    let palette = look.palette;
    let shut = kit::head_ui(ui, look, look.tr(window::KEYS), |ui| {
        let shut = Button::new(look.tr(main::DISMISS), "").weight(Weight::Quiet);
        let shut = shut.named(look.tr(window::KEYS_CLOSE));
        shut.ui(ui, look).clicked()
    });
    ui.columns_const(|all: &mut [Ui; 3]| {
        for (ui, parts) in all.iter_mut().zip(COLUMNS) {
            for title in parts {
                Label::new(look.tr(*title), palette.accent).small().ui(ui);
                let grid = Grid::new(title.en).num_columns(2).min_col_width(98.0);
                grid.min_row_height(20.0).show(ui, |ui| {
                    for (keys, words) in rows(*title) {
                        ui.horizontal(|ui| {
                            keys.split(", ").for_each(|key| cap_ui(ui, look, key));
                        });
                        Label::text(look, words).wrap().ui(ui);
                        ui.end_row();
                    }
                });
            }
        }
    });
    for text in [
        window::KEY_ON_TRACKS,
        window::KEY_IN_FIELDS,
        window::KEY_ESCAPE,
    ] {
        Label::note(look, text).ui(ui);
    }
    shut
}

pub(super) fn cap_ui(ui: &mut Ui, look: Look, key: &str) {
    let frame = Frame::new()
        .fill(look.palette.control)
        .corner_radius(theme::ROUND_SMALL)
        .inner_margin(Margin::symmetric(6, 1));
    let key = egui::RichText::new(key).monospace();
    frame.show(ui, |ui| ui.add(egui::Label::new(key).extend()));
}
