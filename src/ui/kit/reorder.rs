//! Things that a person puts in another order, by dragging one to the place of another or with Alt and the arrow keys.
//! Knows nothing of what they are.

use crate::poses::edit::Way;
use crate::ui::kit::look::Look;
use crate::ui::theme;
use egui::{CornerRadius, CursorIcon, Id, Key, Modifiers, Rect, Response, Sense, Stroke, Ui};

/// Width of the line that shows where a dragged thing would go.
const LINE: f32 = 2.0;

/// How the things stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Along {
    /// One beside the other, row by row.
    Row,
    /// One below the other.
    Column,
}

/// What is dragged, and where all things stand.
#[derive(Debug, Default)]
pub(crate) struct Reorder {
    dragged: Option<usize>,
    places: Vec<Rect>,
}

impl Reorder {
    /// Before the first thing of a frame.
    pub(crate) fn begin(&mut self) {
        self.places.clear();
    }

    /// For each thing in order, before its own controls: those stay on top and work as ever.
    pub(crate) fn place(&mut self, ui: &Ui, rect: Rect, id: Id) {
        let index = self.places.len();
        self.places.push(rect);
        let response = ui.interact(rect, id.with("reorder"), Sense::drag());
        if response.drag_started() {
            self.dragged = Some(index);
        }
    }

    /// After the last thing: shows where the dragged one would go, and says from where to where it went once it is let
    /// go. Esc lets it stay.
    pub(crate) fn end(&mut self, ui: &Ui, look: Look, along: Along) -> Option<(usize, usize)> {
        let from = self.dragged?;
        let (held, cancelled) =
            ui.input(|input| (input.pointer.primary_down(), input.key_pressed(Key::Escape)));
        if cancelled {
            self.dragged = None;
            return None;
        }
        let to = self.target(ui);
        if !held {
            self.dragged = None;
            return to.filter(|to| *to != from).map(|to| (from, to));
        }
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        self.show(ui, look, along, from, to);
        None
    }

    /// The thing whose place is under the pointer.
    fn target(&self, ui: &Ui) -> Option<usize> {
        let at = ui.ctx().pointer_interact_pos()?;
        let room = theme::GAP / 2.0;
        self.places
            .iter()
            .position(|place| place.expand(room).contains(at))
    }

    fn show(&self, ui: &Ui, look: Look, along: Along, from: usize, to: Option<usize>) {
        let painter = ui.painter();
        let round = CornerRadius::same(theme::ROUND_SMALL);
        if let Some(place) = self.places.get(from) {
            painter.rect_filled(*place, round, look.palette.wash(look.palette.accent));
        }
        let Some(to) = to.filter(|to| *to != from) else {
            return;
        };
        let Some(place) = self.places.get(to) else {
            return;
        };
        let stroke = Stroke::new(LINE, look.palette.accent);
        let later = to > from;
        match along {
            Along::Row => {
                let x = if later { place.right() } else { place.left() };
                painter.vline(x, place.y_range(), stroke);
            }
            Along::Column => {
                let y = if later { place.bottom() } else { place.top() };
                painter.hline(place.x_range(), y, stroke);
            }
        }
    }
}

/// Which way Alt and an arrow key move the thing that has the keyboard.
pub(crate) fn keyed(ui: &Ui, response: &Response) -> Option<Way> {
    if !response.has_focus() {
        return None;
    }
    ui.input_mut(|input| {
        let mut pressed = |key| input.consume_key(Modifiers::ALT, key);
        if pressed(Key::ArrowLeft) || pressed(Key::ArrowUp) {
            Some(Way::Earlier)
        } else if pressed(Key::ArrowRight) || pressed(Key::ArrowDown) {
            Some(Way::Later)
        } else {
            None
        }
    })
}
