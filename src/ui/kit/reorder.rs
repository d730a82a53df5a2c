//! Lists that the user reorders by dragging an entry onto another. Independent of the entries' type.

use crate::ui::style::Look;
use crate::ui::theme;
use egui::{CursorIcon, Id, Key, Rect, Sense, Stroke, StrokeKind, Ui};

/// State of the drag in progress.
#[derive(Debug, Default)]
pub(crate) struct Reorder {
    dragged: Option<usize>,
}

impl Reorder {
    /// Call once per entry, before its own controls, which stay on top and keep working. Returns (from, to) when an entry is
    /// dropped onto this one; Esc cancels the drag.
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
