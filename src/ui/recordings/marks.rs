//! Names and times of a recording's marks, in lists and on the timeline.

use crate::record::EventKind;
use crate::ui::kit::Look;
use crate::ui::text::{Text, hold, main, panels, recordings, tune};
use egui::Color32;
use std::time::Duration;

/// Name and colour of a mark; `None` for marks that the timeline does not show.
pub(crate) fn shown(look: Look, kind: EventKind) -> Option<(Text, Color32)> {
    let palette = look.palette;
    Some(match kind {
        EventKind::Fault => (main::FAULT_TITLE, palette.bad),
        EventKind::Stop => (main::STOP, palette.stop_edge),
        EventKind::Armed => (main::DISARM, palette.armed),
        EventKind::LinkLost => (main::STATE_LOST, palette.bad),
        EventKind::Reconnected => (panels::MARK_RECONNECT, palette.ok),
        EventKind::Trial => (tune::COLUMN_TRIAL, palette.accent),
        EventKind::Hold => (hold::HOLD, palette.accent),
        EventKind::Note => (panels::NOTES, palette.text),
        EventKind::Recording => (recordings::RECORDING, palette.warn),
        _ => return None,
    })
}

/// Formats `1:02:03.45`, from the beginning of the recording.
pub(crate) fn clock(since: Duration) -> String {
    let seconds = since.as_secs();
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    let parts = since.subsec_millis() / 10;
    match hours {
        0 => format!("{minutes}:{seconds:02}.{parts:02}"),
        hours => format!("{hours}:{minutes:02}:{seconds:02}.{parts:02}"),
    }
}
