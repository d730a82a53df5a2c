//! Names and times of a recording's marks, in lists and on the timeline.

use crate::app::activity::{PlayKind, RecordedPlay};
use crate::app::settings::Language;
use crate::poses::starter::starter;
use crate::record::EventKind;
use crate::ui::kit::Look;
use crate::ui::text::{Text, hold, main, panels, poses, recordings, tune};
use egui::Color32;
use std::time::Duration;

/// Name and colour of a mark; `None` for marks that the timeline does not show.
pub(crate) fn shown(look: Look, kind: EventKind) -> Option<(Text, Color32)> {
    let palette = look.palette;
    Some(match kind {
        EventKind::Fault => (main::FAULT_TITLE, palette.bad),
        EventKind::Stop => (main::STOP, palette.stop_edge),
        EventKind::Armed => (main::DISARM, palette.armed),
        EventKind::Disarmed => (panels::MARK_DISARMED, palette.muted),
        EventKind::LinkLost => (main::STATE_LOST, palette.bad),
        EventKind::Reconnected => (panels::MARK_RECONNECT, palette.ok),
        EventKind::Trial => (tune::COLUMN_TRIAL, palette.accent),
        EventKind::Play => (poses::POSE, palette.accent),
        EventKind::Hold => (hold::HOLD, palette.accent),
        EventKind::Note => (panels::NOTES, palette.text),
        EventKind::Recording => (recordings::RECORDING, palette.warn),
        _ => return None,
    })
}

/// What plays, as a recording names it: `Pose Fist`. Shipped entries have their name in the window's language.
pub(crate) fn play_words(look: Look, play: &RecordedPlay) -> String {
    let title = match play.kind {
        PlayKind::Pose => poses::POSE,
        PlayKind::Sequence => poses::SEQUENCE,
        PlayKind::Reaction => poses::REACTION,
        PlayKind::Hold => return look.tr(hold::MOVES).to_owned(),
    };
    let shipped = starter().entries();
    let mut names = shipped.filter_map(|entry| starter().named(entry));
    let zh = names.find(|names| names.text == play.name && look.language == Language::Zh);
    let name = zh.map_or(play.name.as_str(), |names| names.zh);
    format!("{} {name}", look.tr(title))
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
