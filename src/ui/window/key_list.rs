//! The list of all keys, over the window. It covers neither STOP nor the top bar, and stops nothing itself.

use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right};
use crate::ui::kit::look::Look;
use crate::ui::text::{Text, keys};
use crate::ui::theme;
use crate::ui::window::keys::{ROWS, Wish};
use egui::{Area, CornerRadius, Id, Order, Rect, Sense, Stroke, StrokeKind, Ui, vec2};

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

    /// Shows it no more.
    pub(crate) fn hide(&mut self) {
        self.open = false;
    }

    /// Draws it in the middle of a place, if it is shown. A click beside it hides it.
    pub(crate) fn ui(&mut self, ui: &Ui, place: Rect, look: Look) {
        if !self.open {
            return;
        }
        let size = vec2(theme::KEY_LIST_WIDTH, height());
        let rect = Rect::from_center_size(place.center(), size.min(place.size()));
        let id = Id::unique("key list");
        let area = Area::new(id).order(Order::Foreground).fixed_pos(rect.min);
        let shut = area.show(ui.ctx(), |ui| list_ui(ui, rect, look)).inner;
        let beside = ui.input(|input| {
            let at = input.pointer.interact_pos();
            input.pointer.any_pressed() && at.is_some_and(|at| !rect.contains(at))
        });
        if shut || beside && !self.fresh {
            self.open = false;
        }
        self.fresh = false;
    }
}

/// The parts of the list: two columns of two.
fn parts() -> [[(Text, Vec<Wish>); 2]; 2] {
    let of = |wanted: fn(Wish) -> bool| {
        let mut wishes: Vec<Wish> = ROWS
            .iter()
            .map(|row| row.wish)
            .filter(|wish| wanted(*wish))
            .collect();
        wishes.dedup();
        wishes
    };
    let motion = of(|wish| {
        matches!(
            wish,
            Wish::Stop | Wish::ArmOrNot | Wish::Open | Wish::Half | Wish::Close
        )
    });
    let joints = of(|wish| matches!(wish, Wish::Joint(_) | Wish::LinkFingers | Wish::AngleUnit));
    let measuring =
        of(|wish| matches!(wish, Wish::Tare | Wish::UndoTare | Wish::Pause | Wish::Note));
    let window = of(|wish| {
        matches!(
            wish,
            Wish::View(_) | Wish::Language | Wish::Theme | Wish::List
        )
    });
    [
        [(keys::MOTION, motion), (keys::JOINTS, joints)],
        [(keys::MEASURING, measuring), (keys::WINDOW, window)],
    ]
}

fn height() -> f32 {
    let rows = |column: &[(Text, Vec<Wish>)]| -> usize {
        column.iter().map(|(_, wishes)| wishes.len() + 1).sum()
    };
    let tallest = parts().iter().map(|column| rows(column)).max();
    let rows = u16::try_from(tallest.unwrap_or_default()).unwrap_or(u16::MAX);
    let foot = 2.0 * theme::KEY_ROW;
    f32::from(rows) * theme::KEY_ROW + foot + theme::CONTROL_LARGE + 2.0 * theme::PAD + theme::GAP
}

/// True if it is to be hidden.
fn list_ui(ui: &mut Ui, rect: Rect, look: Look) -> bool {
    let palette = look.palette;
    // Nothing below it is pressed through it.
    ui.allocate_rect(rect, Sense::click());
    let round = CornerRadius::same(theme::ROUND);
    let painter = ui.painter();
    painter.rect_filled(rect, round, palette.card);
    let edge = Stroke::new(theme::LINE, palette.accent);
    painter.rect_stroke(rect, round, edge, StrokeKind::Inside);
    let mut inner = rect.shrink(theme::PAD);
    let mut head = row(&mut inner, theme::CONTROL_LARGE);
    let shut = Button::new(look.say(keys::SHUT), look.say(keys::CLOSE))
        .named(look.say(keys::CLOSE))
        .weight(Weight::Quiet);
    let width = controls::text_width(ui, look.say(keys::SHUT), theme::body()) + 2.0 * theme::PAD;
    let place = take_right(&mut head, width);
    let shut = shut
        .put(ui, look, place, Id::unique("close key list"))
        .clicked();
    Label::new(look.say(keys::TITLE), palette.text)
        .font(theme::title())
        .put(ui, head);
    let foot = inner.bottom() - 2.0 * theme::KEY_ROW;
    let (inner, foot) = inner.split_top_bottom_at_y(foot);
    let (upper, lower) = foot.split_top_bottom_at_fraction(0.5);
    for (text, place) in [(keys::ON_TRACKS, upper), (keys::IN_FIELDS, lower)] {
        Label::new(look.say(text), palette.muted)
            .small()
            .put(ui, place);
    }
    let (left, right) = inner.split_left_right_at_fraction(0.5);
    let columns = [left.with_max_x(left.right() - theme::PAD), right];
    for (mut column, parts) in columns.into_iter().zip(parts()) {
        for (title, wishes) in parts {
            let place = row(&mut column, theme::KEY_ROW);
            Label::new(look.say(title), palette.accent)
                .small()
                .put(ui, place);
            for wish in wishes {
                let place = row(&mut column, theme::KEY_ROW);
                row_ui(ui, place, look, wish);
            }
        }
    }
    shut
}

/// A piece from the top, with nothing between it and the next.
fn row(rect: &mut Rect, height: f32) -> Rect {
    let (piece, rest) = rect.split_top_bottom_at_y(rect.top() + height);
    *rect = rest;
    piece
}

fn row_ui(ui: &mut Ui, mut place: Rect, look: Look, wish: Wish) {
    let names = wish.keys();
    let mut keys = take_left(&mut place, theme::KEY_COLUMN);
    for name in names.split(", ") {
        let width = controls::text_width(ui, name, theme::number()) + theme::PAD;
        let cap = take_left(&mut keys, width).shrink2(vec2(0.0, theme::KEY_CAP_MARGIN));
        let round = CornerRadius::same(theme::ROUND_SMALL);
        ui.painter().rect_filled(cap, round, look.palette.control);
        Label::new(name, look.palette.text)
            .number()
            .center()
            .put(ui, cap);
        keys.min.x += theme::STEP;
    }
    Label::new(look.say(wish.words()), look.palette.text).put(ui, place);
}
