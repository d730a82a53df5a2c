//! Summary of a drive's state: lamp colour and texts. Draws nothing.

use crate::app::readings::Freshness;
use crate::hand::{Dof, Status, Words};
use crate::ui::kit::pane::Pane;
use crate::ui::style::format;
use crate::ui::text::words;
use egui::Color32;

/// Lamp colour and texts for one drive.
pub(crate) struct DriveWords {
    /// Lamp colour, faded with the age of the reading.
    pub(crate) lamp: Color32,
    /// Title colour: conspicuous only on a fault.
    pub(crate) text: Color32,
    /// Two or three words, or "-".
    pub(crate) title: String,
    /// Title for narrow places.
    pub(crate) short: String,
    /// Title, cause and advice; `None` while the state is unknown.
    pub(crate) words: Option<Words>,
    pub(crate) freshness: Freshness,
}

impl DriveWords {
    /// Texts for the current state of a joint's drive: its first fault, else its status.
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
            // An undocumented status code is shown beside a fault, too.
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
