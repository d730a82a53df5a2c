//! Events of a recording as lines of text: actions of the user, changes of drives and of the link.

use crate::app::readings::fault_recorder::{FaultEventKind, FaultRecording, UserAct};
use crate::hand::{Dof, Faults};
use crate::history::{Mark, MarkKind};
use crate::poses::{Play, Preset};
use crate::ui::kit::Look;
use crate::ui::plots::marks;
use crate::ui::text::{main, notices, panels, poses, words};
use egui::Color32;

/// One line of the list.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EventLine {
    /// Time in seconds since the start of the program.
    pub(crate) at_s: f64,
    pub(crate) text: String,
    /// Same colour as in the plots.
    pub(crate) color: Color32,
}

/// All events, oldest first.
pub(crate) fn lines(look: Look, recording: &FaultRecording) -> Vec<EventLine> {
    let events = recording.events.iter().map(|event| {
        let (text, color) = event_words(look, &event.what);
        EventLine {
            at_s: event.at.secs(),
            text,
            color,
        }
    });
    let marks = recording
        .history
        .marks(recording.from.secs(), recording.to.secs());
    let marks = marks.filter_map(|mark| mark_line(look, mark));
    let mut all: Vec<EventLine> = events.chain(marks).collect();
    all.sort_by(|one, two| one.at_s.total_cmp(&two.at_s));
    all
}

/// Line of a mark. `None` for a fault, which the drive's own line describes better.
fn mark_line(look: Look, mark: &Mark) -> Option<EventLine> {
    // Faults are listed as changes of drives.
    if matches!(mark.kind, MarkKind::Fault(_)) {
        return None;
    }
    let (text, color) = marks::mark_text(look, &mark.kind);
    let at_s = mark.at.secs();
    Some(EventLine { at_s, text, color })
}

fn event_words(look: Look, what: &FaultEventKind) -> (String, Color32) {
    let palette = look.palette;
    let of = |dof, text: &str| look.pair(look.tr(words::dof(dof)), text);
    match what {
        FaultEventKind::UserAct(act) => (act_words(look, act), palette.accent),
        FaultEventKind::Status(dof, status) => {
            let color = if status.is_protective() {
                palette.bad
            } else {
                palette.muted
            };
            (of(*dof, words::status(*status, look.language).title), color)
        }
        FaultEventKind::Faults(dof, bits) => {
            let color = if bits.is_empty() {
                palette.ok
            } else {
                palette.bad
            };
            (of(*dof, &fault_words(look, *bits)), color)
        }
    }
}

/// Titles of all set bits.
fn fault_words(look: Look, bits: Faults) -> String {
    if bits.is_empty() {
        return look.tr(notices::NO_FAULT_BITS).into();
    }
    let titles = bits
        .iter()
        .map(|bit| words::fault(bit, look.language).title);
    titles.collect::<Vec<_>>().join(" + ")
}

fn act_words(look: Look, act: &UserAct) -> String {
    let tr = |text| look.tr(text).to_owned();
    let set = |who: &str, what, value: i16| format!("{who} {} {value}", look.tr(what));
    let joint = |dof| look.tr(words::dof(dof));
    let joints = |dof: &Option<Dof>| dof.map_or_else(|| look.tr(main::EVERY), joint);
    match act {
        UserAct::Disarm => tr(notices::ACT_DISARM),
        UserAct::Target(dof, angle) => set(joint(*dof), notices::ACT_TARGET, angle.get()),
        UserAct::Force(dof, force) => set(joints(dof), notices::ACT_FORCE, force.get()),
        UserAct::Speed(dof, speed) => set(joints(dof), main::NAME_SPEED, speed.get()),
        UserAct::Lock(dof, true) => format!("{} {}", joint(*dof), tr(notices::ACT_LOCK)),
        UserAct::Lock(dof, false) => format!("{} {}", joint(*dof), tr(notices::ACT_UNLOCK)),
        UserAct::Preset(Preset::Open) => tr(main::OPEN),
        UserAct::Preset(Preset::Half) => tr(main::HALF),
        UserAct::Preset(Preset::Close) => tr(main::CLOSE),
        UserAct::Pose(name) => format!("{} {name}", tr(poses::RECALL_NAME)),
        UserAct::Play(play) => {
            let verb = match play {
                Play::Start(_) => poses::START,
                Play::Step(_) => poses::STEP,
                Play::Pause => poses::PAUSE,
                Play::Resume => poses::RESUME,
                Play::End => poses::END,
            };
            look.pair(look.tr(poses::SEQUENCE), look.tr(verb))
        }
        UserAct::ClearErrors => tr(panels::CLEAR),
    }
}
