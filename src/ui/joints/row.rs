//! A joint by its name and colour, and the ids of its parts. Draws nothing.

use crate::hand::Dof;
use crate::ui::kit::Pane;
use crate::ui::text::{Text, words};
use egui::{Color32, Id, Rect, Ui, vec2};

/// Width of the readings at the right.
pub(crate) const READING: f32 = 112.0;

/// One joint, with its names made once.
pub(crate) struct JointRow {
    /// The joint.
    pub(crate) dof: Dof,
    /// What it is called.
    pub(crate) name: &'static str,
    pub(crate) color: Color32,
}

impl JointRow {
    /// The row of a joint.
    pub(crate) fn new(dof: Dof, pane: &Pane<'_>) -> Self {
        Self {
            dof,
            name: pane.look.say(words::dof(dof)),
            color: pane.look.palette.dof[dof],
        }
    }

    /// What a screen reader says of one of its parts.
    pub(crate) fn named(&self, pane: &Pane<'_>, what: Text) -> String {
        format!("{} {}", self.name, pane.look.say(what))
    }

    /// The id of one of its parts.
    pub(crate) fn id(&self, part: &'static str) -> Id {
        Id::unique(("joint", self.dof, part))
    }

    /// Gives the keyboard to the angle, or to the force threshold while the angle cannot be moved.
    pub(crate) fn focus(&self, ui: &Ui, movable: bool) {
        let part = if movable { "angle" } else { "force" };
        ui.memory_mut(|memory| memory.request_focus(self.id(part)));
    }
}

/// The next piece of a line, as high as the line.
pub(crate) fn cell(ui: &mut Ui, width: f32) -> Rect {
    let height = ui.available_height();
    ui.allocate_space(vec2(width, height)).1
}
