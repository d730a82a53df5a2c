//! Assignment of a gamepad's controls as TOML, version 1 (assets/manual/gamepad.md). A file is applied as a whole or not at all.

use crate::inputs::pad::control::PadControl;
use crate::inputs::pad::map::{POSE_CHARS_MAX, PadAction, PadMap};
use crate::store::toml_file::VERSION;
use crate::store::{FileCause, FileError, FileText};
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

/// Format name in such a file.
pub const FORMAT: &str = "handscope-gamepad";
/// Size limit of such a file, bytes.
pub const BYTES_MAX: u64 = 64 * 1024;
/// Characters of a wrong value repeated in the error.
const QUOTED_CHARS: usize = 40;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MapRow {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: i64,
    controls: Spanned<BTreeMap<Spanned<String>, Spanned<String>>>,
}

/// Texts of the actions without a name.
const PLAIN: [(&str, PadAction); 8] = [
    ("nothing", PadAction::Nothing),
    ("dead-man", PadAction::DeadMan),
    ("stop", PadAction::Stop),
    ("close fingers", PadAction::CloseFingers),
    ("bend thumb", PadAction::BendThumb),
    ("close gap", PadAction::CloseGap),
    ("rotate thumb", PadAction::RotateThumb),
    ("choose fingers", PadAction::ChooseFingers),
];

/// Text of an action in a file.
pub fn action_words(action: &PadAction) -> String {
    if let PadAction::Pose(name) = action {
        return format!("pose {name}");
    }
    let known = PLAIN.into_iter().find(|(_, own)| own == action);
    known.map_or_else(String::new, |(words, _)| words.into())
}

/// Parses the text of an action.
pub fn action_of(words: &str) -> Option<PadAction> {
    if let Some(name) = words.strip_prefix("pose ") {
        let name = name.trim();
        let is_name = (1..=POSE_CHARS_MAX).contains(&name.chars().count())
            && !name.chars().any(char::is_control);
        return is_name.then(|| PadAction::Pose(name.into()));
    }
    let known = PLAIN.into_iter().find(|(own, _)| *own == words);
    known.map(|(_, action)| action)
}

/// Parses a file's text.
///
/// # Errors
/// [`FileError`] with line and field; such a text is rejected as a whole.
pub fn read(text: &str) -> Result<PadMap, FileError> {
    let source = FileText::of(text, FORMAT)?;
    let row: MapRow = source.parse()?;
    let place = row.controls.span();
    let mut actions = BTreeMap::new();
    for (name, words) in row.controls.get_ref() {
        let control = PadControl::named(name.get_ref());
        let control = control.ok_or_else(|| {
            let allowed = PadControl::ALL.map(PadControl::name).join(", ");
            wrong(name.get_ref(), &format!("a control: {allowed}"))
        });
        let control = control.map_err(|cause| source.blame(name.span(), "controls", cause))?;
        let at = |cause| source.blame(words.span(), control.name(), cause);
        let action = action_of(words.get_ref());
        let action = action.filter(|action| action.fits(control.kind()));
        let action = action.ok_or_else(|| at(wrong(words.get_ref(), &allowed(control))))?;
        if action.is_single() && actions.values().any(|other| *other == action) {
            let name = words.get_ref().clone();
            return Err(at(FileCause::Twice { name }));
        }
        actions.insert(control, action);
    }
    for needed in [PadAction::DeadMan, PadAction::Stop] {
        if !actions.values().any(|action| *action == needed) {
            let name = action_words(&needed);
            let cause = FileCause::Absent { name };
            return Err(source.blame(place, "controls", cause));
        }
    }
    PadMap::of(actions).ok_or_else(|| FileCause::Empty.into())
}

/// Formats a map as a file's text.
pub fn write(map: &PadMap) -> String {
    let head = format!("format = \"{FORMAT}\"\nversion = {VERSION}\n\n[controls]\n");
    let used = PadControl::ALL.into_iter();
    let used = used.filter(|control| *map.action(*control) != PadAction::Nothing);
    let lines = used.map(|control| {
        let words = toml::Value::String(action_words(map.action(control)));
        format!("{} = {words}\n", control.name())
    });
    lines.fold(head, |text, line| text + &line)
}

/// Text that lists the actions of a control.
fn allowed(control: PadControl) -> String {
    let plain = PadAction::choices(control.kind()).iter().map(action_words);
    let mut all: Vec<String> = plain.map(|words| format!("\"{words}\"")).collect();
    let pose = PadAction::Pose("NAME".into());
    if pose.fits(control.kind()) {
        all.push(format!("\"{}\"", action_words(&pose)));
    }
    format!("what this control can do: {}", all.join(", "))
}

fn wrong(got: &str, allowed: &str) -> FileCause {
    let start: String = got.chars().take(QUOTED_CHARS).collect();
    FileCause::Value {
        got: format!("\"{}\"", start.escape_debug()),
        allowed: allowed.into(),
    }
}
