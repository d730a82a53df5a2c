//! What a drive says of itself: the colour of its lamp and the words beside it. Draws nothing.

use crate::app::readings::Freshness;
use crate::hand::{Dof, Status, Words};
use crate::ui::kit::pane::Pane;
use crate::ui::style::format;
use crate::ui::text::words;
use egui::Color32;

/// What stands beside a drive's lamp.
pub(crate) struct DriveWords {
    /// Of the lamp, as fresh as the reading is.
    pub(crate) lamp: Color32,
    /// Of the title: loud only where something is wrong.
    pub(crate) text: Color32,
    /// In two or three words, or "-".
    pub(crate) title: String,
    /// The same where room is short.
    pub(crate) short: String,
    /// Title, cause and advice, if anything is known.
    pub(crate) words: Option<Words>,
    pub(crate) freshness: Freshness,
}

impl DriveWords {
    /// The words for a joint's drive now: its first fault, else its status.
    pub(crate) fn of(pane: &Pane<'_>, dof: Dof) -> Self {
        let look = pane.look;
        let palette = look.palette;
        let sample = &pane.hand().readings.sample;
        let status = sample.status.map(|group| group.value[dof]);
        let faults = sample.faults.map(|group| group.value[dof]);
        let fault = faults.and_then(|faults| faults.iter().next());
        let asked = match fault {
            Some(_) => sample.faults.map(|group| group.asked),
            None => sample.status.map(|group| group.asked),
        };
        let freshness = pane.freshness(asked);
        let live = palette.drive(fault, status);
        let words = match (fault, status) {
            (Some(fault), _) => Some(words::fault(fault, look.language)),
            (None, Some(status)) => Some(words::status(status, look.language)),
            (None, None) => None,
        };
        let title = words.map_or(format::UNKNOWN, |words| words.title);
        let title = match (fault, status) {
            (None, Some(Status::Unknown(code))) => format!("{title} ({code})"),
            _ => title.to_owned(),
        };
        let short = match (fault, status) {
            // A code that the manual does not list stands beside a fault, too.
            (Some(fault), Some(Status::Unknown(code))) => {
                format!("{} ({code})", words::fault_short(fault, look.language))
            }
            (Some(fault), _) => words::fault_short(fault, look.language).into(),
            (None, _) => title.clone(),
        };
        let lamp = look.value(freshness, live);
        let text = if live == palette.bad {
            lamp
        } else {
            look.value(freshness, palette.muted)
        };
        Self {
            lamp,
            text,
            title,
            short,
            words,
            freshness,
        }
    }
}
