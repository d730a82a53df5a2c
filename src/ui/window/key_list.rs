//! The list of all keys, over the window. It covers neither STOP nor the top bar, and stops nothing itself.

use crate::ui::kit::{self, Button, Label, Look, Opens, Weight};
use crate::ui::text::{Text, keys};
use crate::ui::theme;
use crate::ui::window::keys::{ROWS, Wish, ZOOM};
use egui::{Align2, Frame, Grid, Id, Margin, Rect, Stroke, Ui, Window};

/// The list, shown or not.
#[derive(Debug, Default)]
pub(crate) struct KeyList {
    open: bool,
    /// The press that opened it must not close it again.
    fresh: bool,
}

impl KeyList {
    /// Shows it, or hides it.
    pub(crate) fn toggle(&mut self) {
        self.open = !self.open;
        self.fresh = self.open;
    }

    /// True while it is shown.
    pub(crate) const fn is_open(&self) -> bool {
        self.open
    }

    /// Shows it no more.
    pub(crate) fn hide(&mut self) {
        self.open = false;
    }

    /// Draws it in the middle of a place, if it is shown. A click beside it hides it.
    pub(crate) fn ui(&mut self, ui: &Ui, place: Rect, look: Look) {
        if !self.open {
            return;
        }
        let edge = Stroke::new(theme::LINE, look.palette.accent);
        let frame = Frame::window(ui.style()).stroke(edge);
        let window = Window::new(look.say(keys::TITLE))
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

/// A title, and below it the names of keys with what they do.
type KeyGroup = (Text, Vec<(String, Text)>);

/// The columns of the list.
fn columns() -> [Vec<KeyGroup>; 3] {
    let part = |title: Text, wanted: fn(Wish) -> bool| -> KeyGroup {
        let wishes = ROWS.iter().map(|row| row.wish);
        let mut wishes: Vec<Wish> = wishes.filter(|wish| wanted(*wish)).collect();
        wishes.dedup();
        let named = |wish: Wish| (wish.keys(), wish.words());
        (title, wishes.into_iter().map(named).collect())
    };
    let motion = part(keys::MOTION, |wish| {
        matches!(
            wish,
            Wish::Stop | Wish::ArmOrNot | Wish::Open | Wish::Half | Wish::Close
        )
    });
    let joints = part(keys::JOINTS, |wish| {
        matches!(wish, Wish::Joint(_) | Wish::LinkFingers | Wish::AngleUnit)
    });
    let measuring = part(keys::MEASURING, |wish| {
        matches!(
            wish,
            Wish::Tare | Wish::UndoTare | Wish::Pause | Wish::Opens(Opens::Note)
        )
    });
    let mut window = part(keys::WINDOW, |wish| {
        matches!(
            wish,
            Wish::Opens(Opens::View(_) | Opens::Keys) | Wish::Language | Wish::Theme
        )
    });
    let zoom = ZOOM.map(|(key, words)| (key.to_owned(), words));
    window.1.extend(zoom);
    [vec![motion, measuring], vec![joints], vec![window]]
}

/// True if it is to be hidden.
fn list_ui(ui: &mut Ui, look: Look) -> bool {
    let palette = look.palette;
    let shut = kit::head_ui(ui, look, look.say(keys::TITLE), |ui| {
        let shut = Button::new(look.say(keys::SHUT), "").weight(Weight::Quiet);
        shut.named(look.say(keys::CLOSE)).ui(ui, look).clicked()
    });
    ui.columns_const(|all: &mut [Ui; 3]| {
        for (ui, parts) in all.iter_mut().zip(columns()) {
            for (title, rows) in parts {
                Label::new(look.say(title), palette.accent).small().ui(ui);
                let grid = Grid::new(title.en).num_columns(2).min_col_width(110.0);
                grid.min_row_height(20.0).show(ui, |ui| {
                    for (keys, words) in rows {
                        ui.horizontal(|ui| {
                            keys.split(", ").for_each(|key| cap_ui(ui, look, key));
                        });
                        Label::said(look, words).ui(ui);
                        ui.end_row();
                    }
                });
            }
        }
    });
    for text in [keys::ON_TRACKS, keys::IN_FIELDS, keys::ESCAPE] {
        Label::note(look, text).ui(ui);
    }
    shut
}

fn cap_ui(ui: &mut Ui, look: Look, key: &str) {
    let frame = Frame::new()
        .fill(look.palette.control)
        .corner_radius(theme::ROUND_SMALL)
        .inner_margin(Margin::symmetric(6, 1));
    let key = egui::RichText::new(key).monospace();
    frame.show(ui, |ui| ui.add(egui::Label::new(key).extend()));
}
