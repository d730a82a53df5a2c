//! Things that a person puts in another order, by dragging one to the place of another or with Alt and the arrow keys.
//! Knows nothing of what they are.

use crate::ui::kit::look::Look;
use crate::ui::theme;
use egui::{CursorIcon, Id, Key, Modifiers, Rect, Response, Sense, Stroke, StrokeKind, Ui};

/// To which side something moves in its row.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ShiftDirection {
    /// Towards the first.
    Earlier,
    /// Towards the last.
    Later,
}

impl ShiftDirection {
    /// The place beside this one.
    pub(crate) const fn from(self, at: usize) -> usize {
        match self {
            Self::Earlier => at.saturating_sub(1),
            Self::Later => at + 1,
        }
    }
}

/// What is dragged.
#[derive(Debug, Default)]
pub(crate) struct Reorder {
    dragged: Option<usize>,
}

impl Reorder {
    /// For each thing, before its own controls: those stay on top and work as ever. From where to where one went, once it
    /// is let go over this one. Esc lets it stay.
    pub(crate) fn place(
        &mut self,
        ui: &Ui,
        look: Look,
        rect: Rect,
        (at, id): (usize, Id),
    ) -> Option<(usize, usize)> {
        let own = ui.interact(rect, id.with("reorder"), Sense::drag());
        if own.drag_started() {
            self.dragged = Some(at);
        }
        let from = self.dragged?;
        let (held, released, escaped) = ui.input(|input| {
            let pointer = &input.pointer;
            let escaped = input.key_pressed(Key::Escape);
            (pointer.primary_down(), pointer.primary_released(), escaped)
        });
        if escaped || !(held || released) {
            self.dragged = None;
            return None;
        }
        let pointer = ui.ctx().pointer_interact_pos()?;
        if !rect.contains(pointer) {
            return None;
        }
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        let stroke = Stroke::new(theme::STRONG, look.palette.accent);
        let round = theme::ROUND_SMALL;
        ui.painter()
            .rect_stroke(rect, round, stroke, StrokeKind::Outside);
        (released && from != at).then_some((from, at))
    }
}

/// Which way Alt and an arrow key move the thing that has the keyboard.
pub(crate) fn keyed(ui: &Ui, response: &Response) -> Option<ShiftDirection> {
    if !response.has_focus() {
        return None;
    }
    ui.input_mut(|input| {
        let mut pressed = |key| input.consume_key(Modifiers::ALT, key);
        if pressed(Key::ArrowLeft) || pressed(Key::ArrowUp) {
            Some(ShiftDirection::Earlier)
        } else if pressed(Key::ArrowRight) || pressed(Key::ArrowDown) {
            Some(ShiftDirection::Later)
        } else {
            None
        }
    })
}
