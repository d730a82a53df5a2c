//! Tabs of the window, and the views in them.

use crate::ui::text::{Text, checkup, inputs, main, recordings, window};

/// One of the five tabs that the header switches between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Tab {
    /// The hand, its joints and its plots.
    Live,
    /// Grasp trials: plan, series and results.
    Tune,
    /// Recorded sessions.
    Recordings,
    /// The hand as a device: link, parameters, check-up and wire traffic.
    Hand,
    /// Other inputs and controllers that may see or move the hand.
    Share,
}

impl Tab {
    /// All tabs, in header order.
    pub const ALL: [Self; 5] = [
        Self::Live,
        Self::Tune,
        Self::Recordings,
        Self::Hand,
        Self::Share,
    ];

    pub(crate) const fn title(self) -> Text {
        match self {
            Self::Live => main::TAB_LIVE,
            Self::Tune => main::TAB_TUNE,
            Self::Recordings => recordings::TITLE,
            Self::Hand => window::PLACE_HAND,
            Self::Share => inputs::TITLE,
        }
    }

    /// Views of this tab, the first being its default.
    pub const fn views(self) -> &'static [View] {
        match self {
            Self::Live => &[View::Live, View::Touch, View::Poses, View::Faults],
            Self::Tune => &[View::Tune, View::Compare],
            Self::Recordings => &[View::Recordings],
            Self::Hand => &[View::Connection, View::Device, View::Checkup, View::Traffic],
            Self::Share => &[View::Inputs],
        }
    }
}

/// A view: one screen of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum View {
    /// Joints, the hand, and plots.
    #[default]
    Live,
    /// Fingertip details in place of the plots.
    Touch,
    /// The plan of grasp trials beside their results.
    Tune,
    /// Trial results alone.
    Compare,
    /// Faults, statuses and messages, in place of the plots.
    Faults,
    /// The user's poses, sequences of them, and the gestures in the hand, in place of the plots.
    Poses,
    /// Parameters of the hand (live, staged, saved) and its flash.
    Device,
    /// Check-up of the hand, and the results of the last one.
    Checkup,
    /// The link and its settings.
    Connection,
    /// Inputs besides the window that may move the hand, and the current user of each.
    Inputs,
    /// Wire traffic, frame by frame.
    Traffic,
    /// Recorded sessions.
    Recordings,
}

impl View {
    /// All views, in the order in which they are listed and drawn.
    pub const ALL: [Self; 12] = [
        Self::Live,
        Self::Touch,
        Self::Tune,
        Self::Compare,
        Self::Faults,
        Self::Poses,
        Self::Device,
        Self::Checkup,
        Self::Connection,
        Self::Inputs,
        Self::Traffic,
        Self::Recordings,
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
            Self::Checkup => ("checkup", checkup::TITLE),
            Self::Connection => ("connection", main::TAB_CONNECTION),
            Self::Inputs => ("inputs", inputs::TITLE),
            Self::Traffic => ("traffic", main::TAB_TRAFFIC),
            Self::Recordings => ("sessions", recordings::TITLE),
        }
    }

    /// Returns the tab that contains this view.
    pub const fn tab(self) -> Tab {
        match self {
            Self::Live | Self::Touch | Self::Poses | Self::Faults => Tab::Live,
            Self::Tune | Self::Compare => Tab::Tune,
            Self::Recordings => Tab::Recordings,
            Self::Connection | Self::Device | Self::Checkup | Self::Traffic => Tab::Hand,
            Self::Inputs => Tab::Share,
        }
    }

    /// Finds a view by its stable name.
    pub fn by_name(name: &str) -> Option<Self> {
        // The poses view was called "gestures" before poses were added.
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

    #[test]
    fn every_view_is_in_its_tab() {
        for view in View::ALL {
            for tab in Tab::ALL {
                let is_there = tab.views().contains(&view);
                assert_eq!(is_there, view.tab() == tab, "{view:?} {tab:?}");
            }
        }
    }
}
