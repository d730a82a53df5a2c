//! Name, colour and widget ids of a joint. Draws nothing.

use crate::hand::Dof;
use crate::ui::kit::Pane;
use crate::ui::text::{Text, words};
use egui::{Color32, Id, Rect, Ui, vec2};

/// Width of the readings at the right.
pub(crate) const READING: f32 = 112.0;

/// Width of the caption of a track; where a row has no caption, of its warnings.
pub(crate) const CAPTION: f32 = 40.0;

/// One joint with its name and colour.
pub(crate) struct JointRow {
    pub(crate) dof: Dof,
    /// Name in the window's language.
    pub(crate) name: &'static str,
    pub(crate) color: Color32,
}

impl JointRow {
    pub(crate) fn new(dof: Dof, pane: &Pane<'_>) -> Self {
        Self {
            dof,
            name: pane.look.tr(words::dof(dof)),
            color: pane.look.palette.dof[dof],
        }
    }

    /// Accessible name of one of its parts.
    pub(crate) fn named(&self, pane: &Pane<'_>, what: Text) -> String {
        format!("{} {}", self.name, pane.look.tr(what))
    }

    /// Widget id of one of its parts.
    pub(crate) fn id(&self, part: &'static str) -> Id {
        Id::unique(("joint", self.dof, part))
    }

    /// Focuses the angle, or the force threshold while the angle cannot be moved.
    pub(crate) fn focus(&self, ui: &Ui, movable: bool) {
        let part = if movable { "angle" } else { "force" };
        ui.memory_mut(|memory| memory.request_focus(self.id(part)));
    }
}

/// Allocates the next part of a line, at the line's height.
pub(crate) fn cell(ui: &mut Ui, width: f32) -> Rect {
    let height = ui.available_height();
    ui.allocate_space(vec2(width, height)).1
}
