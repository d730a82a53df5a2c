//! Things that the user puts in another order, by dragging one to the place of another.
//! Knows nothing of what they are.

use crate::ui::style::Look;
use crate::ui::theme;
use egui::{CursorIcon, Id, Key, Rect, Sense, Stroke, StrokeKind, Ui};

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
        at: usize,
        (id, rect): (Id, Rect),
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
