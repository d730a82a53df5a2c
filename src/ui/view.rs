//! The views of the window.

use crate::ui::text::{Text, inputs, main, sessions};

/// The parts of the window that can be looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum View {
    /// Plots, fingertips, faults and gestures together.
    #[default]
    Live,
    /// The fingertips, large.
    Touch,
    /// The plan of grasp trials, and the series that runs.
    Tune,
    /// What trials came to.
    Compare,
    /// Faults, statuses and messages.
    Faults,
    /// The person's poses, sequences of them, and the gestures in the hand.
    Poses,
    /// What the hand keeps: live, staged, saved; its flash.
    Device,
    /// The link and its settings.
    Connection,
    /// What besides the window may move the hand, and who uses it.
    Inputs,
    /// What goes over the wire, frame by frame.
    Traffic,
    /// What was recorded.
    Sessions,
}

impl View {
    /// All, in the order of the tabs.
    pub const ALL: [Self; 11] = [
        Self::Live,
        Self::Touch,
        Self::Tune,
        Self::Compare,
        Self::Faults,
        Self::Poses,
        Self::Device,
        Self::Connection,
        Self::Inputs,
        Self::Traffic,
        Self::Sessions,
    ];

    /// Stable lower-case name for the command line and files.
    pub const fn name(self) -> &'static str {
        self.names().0
    }

    pub(crate) const fn title(self) -> Text {
        self.names().1
    }

    const fn names(self) -> (&'static str, Text) {
        match self {
            Self::Live => ("live", main::TAB_LIVE),
            Self::Touch => ("touch", main::TAB_TOUCH),
            Self::Tune => ("tune", main::TAB_TUNE),
            Self::Compare => ("compare", main::TAB_COMPARE),
            Self::Faults => ("faults", main::TAB_FAULTS),
            Self::Poses => ("poses", main::TAB_POSES),
            Self::Device => ("device", main::TAB_DEVICE),
            Self::Connection => ("connection", main::TAB_CONNECTION),
            Self::Inputs => ("inputs", inputs::TITLE),
            Self::Traffic => ("traffic", main::TAB_TRAFFIC),
            Self::Sessions => ("sessions", sessions::TITLE),
        }
    }

    /// The view with this name.
    pub fn by_name(name: &str) -> Option<Self> {
        // What this view was called before poses were added.
        let name = if name == "gestures" { "poses" } else { name };
        Self::ALL.into_iter().find(|view| view.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_view_is_found_by_its_name() {
        for view in View::ALL {
            assert_eq!(View::by_name(view.name()), Some(view));
        }
        assert_eq!(View::by_name("LIVE"), None);
    }
}
