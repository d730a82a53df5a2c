//! All keys that work everywhere: one table of key, effect and name, which the key list also shows. Keys of a single control,
//! such as the arrows of a track, belong to that control. Executes nothing.

use crate::app::controls::HoldKey;
use crate::hand::Dof;
use crate::poses::library::EntryKey;
use crate::ui::kit::ViewRequest;
use crate::ui::text::{Text, main, panels, window, words};
use crate::ui::view::{Tab, View};
use egui::{Event, InputState, Key, Modifiers, Ui};

/// Effect of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    /// Hold now.
    Stop,
    /// Arm, or disarm.
    ArmOrNot,
    /// The hand may move while this key is held, if the setting is on.
    HoldToRun,
    /// Open all joints.
    Open,
    /// Close all joints halfway.
    Half,
    /// Bend all joints.
    Close,
    /// Show the hand with this index, from 0.
    Hand(usize),
    /// Run the pose or demo assigned to this key.
    Entry(EntryKey),
    /// Focus this joint's angle.
    Joint(Dof),
    /// Link or unlink the four fingers.
    LinkFingers,
    /// Switch to the next unit of angles.
    AngleUnit,
    /// Tare all fingertips.
    Tare,
    /// Undo the last taring.
    UndoTare,
    /// Pause or resume the plots.
    Pause,
    /// Switch the language.
    Language,
    /// Switch the colours.
    Theme,
    /// Open a view or overlay.
    Opens(ViewRequest),
}

/// Effect of Esc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Escape {
    /// Stops the hand, and may close an overlay as well.
    Stops,
    /// Only closes what is open.
    Closes,
}

/// One key and its effect.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KeyRow {
    pub(crate) modifiers: Modifiers,
    pub(crate) key: Key,
    pub(crate) wish: Wish,
}

const fn row(modifiers: Modifiers, key: Key, wish: Wish) -> KeyRow {
    KeyRow {
        modifiers,
        key,
        wish,
    }
}

const fn opens(modifiers: Modifiers, key: Key, opens: ViewRequest) -> KeyRow {
    row(modifiers, key, Wish::Opens(opens))
}

const NONE: Modifiers = Modifiers::NONE;
/// Keys that may cause motion require two keys, so that a book on the keyboard moves nothing.
const SHIFT: Modifiers = Modifiers::SHIFT;
const COMMAND: Modifiers = Modifiers::COMMAND;
const ALT: Modifiers = Modifiers::ALT;
/// The hold-to-run key.
const HOLD_TO_RUN: Key = Key::H;

/// All keys, in the order of the list. Of two rows with the same key, the one with more modifiers comes first.
pub(crate) static ROWS: [KeyRow; 38] = [
    row(NONE, Key::Space, Wish::Stop),
    row(NONE, Key::Escape, Wish::Stop),
    row(SHIFT, Key::A, Wish::ArmOrNot),
    row(NONE, HOLD_TO_RUN, Wish::HoldToRun),
    row(SHIFT, Key::O, Wish::Open),
    row(SHIFT, Key::H, Wish::Half),
    row(SHIFT, Key::C, Wish::Close),
    opens(COMMAND, Key::Num1, ViewRequest::Tab(Tab::Live)),
    opens(COMMAND, Key::Num2, ViewRequest::Tab(Tab::Tune)),
    opens(COMMAND, Key::Num3, ViewRequest::Tab(Tab::Recordings)),
    opens(COMMAND, Key::Num4, ViewRequest::Tab(Tab::Hand)),
    opens(COMMAND, Key::Num5, ViewRequest::Tab(Tab::Share)),
    opens(COMMAND, Key::Num6, ViewRequest::Faults),
    row(ALT, Key::Num1, Wish::Hand(0)),
    row(ALT, Key::Num2, Wish::Hand(1)),
    row(ALT, Key::Num3, Wish::Hand(2)),
    row(ALT, Key::Num4, Wish::Hand(3)),
    row(ALT, Key::Num5, Wish::Hand(4)),
    row(ALT, Key::Num6, Wish::Hand(5)),
    row(ALT, Key::Num7, Wish::Hand(6)),
    row(ALT, Key::Num8, Wish::Hand(7)),
    row(NONE, Key::Num1, Wish::Joint(Dof::Little)),
    row(NONE, Key::Num2, Wish::Joint(Dof::Ring)),
    row(NONE, Key::Num3, Wish::Joint(Dof::Middle)),
    row(NONE, Key::Num4, Wish::Joint(Dof::Index)),
    row(NONE, Key::Num5, Wish::Joint(Dof::ThumbBend)),
    row(NONE, Key::Num6, Wish::Joint(Dof::ThumbRotate)),
    row(ALT, Key::L, Wish::LinkFingers),
    row(NONE, Key::U, Wish::AngleUnit),
    row(SHIFT, Key::T, Wish::Tare),
    row(COMMAND, Key::T, Wish::UndoTare),
    row(NONE, Key::P, Wish::Pause),
    opens(NONE, Key::N, ViewRequest::Note),
    row(COMMAND, Key::L, Wish::Language),
    row(COMMAND, Key::D, Wish::Theme),
    opens(NONE, Key::F1, ViewRequest::Keys),
    opens(NONE, Key::Questionmark, ViewRequest::Keys),
    opens(COMMAND, Key::K, ViewRequest::Palette),
];

/// Name of egui's command modifier.
pub(crate) const COMMAND_NAME: &str = if cfg!(target_os = "macos") {
    "Cmd"
} else {
    "Ctrl"
};

/// Keys with which, together with the command modifier, egui itself zooms the window.
pub(crate) const ZOOM: [(char, Text); 3] = [
    ('+', window::KEY_ZOOM_IN),
    ('-', window::KEY_ZOOM_OUT),
    ('0', window::KEY_ZOOM_RESET),
];

impl KeyRow {
    /// Name as printed on the keyboard: `Shift+A`.
    pub(crate) fn name(self) -> String {
        let key = match self.key {
            Key::Escape => "Esc",
            Key::Questionmark => "?",
            key => key.name(),
        };
        match self.modifiers {
            SHIFT => format!("Shift+{key}"),
            ALT => format!("Alt+{key}"),
            COMMAND => format!("{COMMAND_NAME}+{key}"),
            _ => key.to_owned(),
        }
    }

    /// True for a stop key, whatever modifiers are held.
    fn is_stop(self, event: &Event) -> bool {
        matches!(event, Event::Key { key, .. } if *key == self.key && self.wish == Wish::Stop)
    }

    fn is_meant(self, event: &Event) -> bool {
        match event {
            Event::Key { key, modifiers, .. } => {
                let plain = self.modifiers == NONE && self.key != Key::Questionmark;
                // A letter with Shift is a different key.
                let alone = !plain || !modifiers.shift && !modifiers.command && !modifiers.alt;
                *key == self.key && alone && modifiers.matches_logically(self.modifiers)
            }
            _ => false,
        }
    }
}

impl Wish {
    /// Description.
    pub(crate) const fn words(self) -> Text {
        match self {
            Self::Stop => window::KEY_STOP,
            Self::ArmOrNot => window::KEY_ARM,
            Self::HoldToRun => window::KEY_HOLD,
            Self::Open => main::OPEN,
            Self::Half => main::HALF,
            Self::Close => main::CLOSE,
            Self::Entry(_) => window::KEY_ENTRY,
            Self::Hand(_) => window::KEY_HAND,
            Self::Joint(dof) => words::dof(dof),
            Self::LinkFingers => window::KEY_LINK,
            Self::AngleUnit => window::KEY_UNIT,
            Self::Tare => panels::TARE_ALL,
            Self::UndoTare => window::KEY_UNDO_TARE,
            Self::Pause => panels::PAUSE_NAME,
            Self::Language => window::KEY_LANGUAGE,
            Self::Theme => main::THEME,
            Self::Opens(ViewRequest::View(view)) => view.title(),
            Self::Opens(ViewRequest::Tab(tab)) => tab.title(),
            Self::Opens(ViewRequest::Faults) => View::Faults.title(),
            Self::Opens(ViewRequest::Note) => window::KEY_NOTE,
            Self::Opens(ViewRequest::Keys) => window::KEY_LIST,
            Self::Opens(ViewRequest::Palette) => window::KEY_COMMANDS,
            Self::Opens(ViewRequest::Drive(dof)) => words::dof(dof),
        }
    }

    /// True if it may move a hand, now or later.
    pub(crate) const fn moves(self) -> bool {
        matches!(
            self,
            Self::ArmOrNot
                | Self::HoldToRun
                | Self::Open
                | Self::Half
                | Self::Close
                | Self::Entry(_)
                | Self::LinkFingers
                | Self::Tare
                | Self::UndoTare
        )
    }

    /// Group in the list of keys.
    pub(crate) const fn group(self) -> Text {
        match self {
            Self::Stop
            | Self::ArmOrNot
            | Self::HoldToRun
            | Self::Open
            | Self::Half
            | Self::Close
            | Self::Entry(_) => window::KEY_MOTION,
            Self::Hand(_) => window::KEY_HANDS,
            Self::Joint(_) | Self::LinkFingers | Self::AngleUnit => window::KEY_JOINTS,
            Self::Tare | Self::UndoTare | Self::Pause | Self::Opens(ViewRequest::Note) => {
                window::KEY_MEASURING
            }
            Self::Opens(_) | Self::Language | Self::Theme => window::KEY_WINDOW,
        }
    }

    /// Names of its keys, for tooltips and the list.
    pub(crate) fn keys(self) -> String {
        let own = ROWS.iter().filter(|row| row.wish == self);
        let names: Vec<String> = own.map(|row| row.name()).collect();
        names.join(", ")
    }
}

/// Removes the keys that work everywhere from the input before any control sees them. Returns their effects, in order.
/// Letters and Space go to a focused text field; Esc only while the hand is at rest.
pub(crate) fn consume(ui: &Ui, escape: Escape) -> Vec<Wish> {
    let typing = ui.ctx().text_edit_focused();
    ui.input_mut(|input| consume_from(input, typing, escape))
}

/// State of the hold-to-run key.
pub(crate) fn hold_key(ui: &Ui, wishes: &[Wish]) -> HoldKey {
    let typing = ui.ctx().text_edit_focused();
    let is_down = ui.input(|input| input.focused && input.key_down(HOLD_TO_RUN));
    if !is_down || typing {
        HoldKey::LetGo
    } else if wishes.contains(&Wish::HoldToRun) {
        HoldKey::Pressed
    } else {
        HoldKey::Held
    }
}

/// While a series of trials runs, any key is a stop: removes all keys from the input. Auto-repeat of a key held before does
/// not count, and Esc stays in the input to close what is open.
pub(crate) fn consume_any(ui: &Ui) -> Vec<Wish> {
    ui.input_mut(consume_any_from)
}

fn consume_any_from(input: &mut InputState) -> Vec<Wish> {
    let mut wishes = Vec::new();
    input.events.retain(|event| match event {
        Event::Key {
            key,
            pressed: true,
            repeat: false,
            ..
        } => {
            wishes = vec![Wish::Stop];
            *key == Key::Escape
        }
        Event::Text(_) | Event::Ime(_) | Event::Paste(_) | Event::Cut | Event::Copy => {
            wishes = vec![Wish::Stop];
            false
        }
        Event::Key { .. } => false,
        _ => true,
    });
    wishes
}

fn consume_from(input: &mut InputState, typing: bool, escape: Escape) -> Vec<Wish> {
    let mut wishes = Vec::new();
    let mut opens_a_field = false;
    input.events.retain(|event| {
        let is_meant = |row: &&KeyRow| row.is_meant(event) || row.is_stop(event);
        let meant = ROWS.iter().find(is_meant);
        let Some(row) = meant.filter(|row| !typing || row.key == Key::Escape) else {
            let key = entry_key(event).filter(|_| !typing && meant.is_none());
            wishes.extend(key.map(Wish::Entry));
            return key.is_none();
        };
        if let Event::Key {
            pressed: true,
            repeat: false,
            ..
        } = event
            && (row.key != Key::Escape || escape == Escape::Stops)
        {
            wishes.push(row.wish);
            opens_a_field |= row.wish == Wish::Opens(ViewRequest::Note);
        }
        // Esc stays in the input: it also closes menus and dialogs.
        row.key == Key::Escape
    });
    if opens_a_field {
        // The same press must not type its letter into the field that it opens.
        input
            .events
            .retain(|event| !matches!(event, Event::Text(_)));
    }
    wishes
}

/// Key of a pose or demo: Shift and a letter or digit that has no other effect.
fn entry_key(event: &Event) -> Option<EntryKey> {
    let Event::Key {
        key,
        physical_key,
        pressed: true,
        repeat: false,
        modifiers,
    } = event
    else {
        return None;
    };
    let alone = modifiers.shift && !modifiers.command && !modifiers.ctrl && !modifiers.alt;
    // With Shift, the digits of many keyboards are other characters.
    let names = [Some(*key), *physical_key].into_iter().flatten();
    let mut keys = names.filter_map(|key| EntryKey::try_from(key.name().to_owned()).ok());
    keys.next().filter(|_| alone)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(row: KeyRow, repeat: bool) -> Event {
        Event::Key {
            key: row.key,
            physical_key: None,
            pressed: true,
            repeat,
            modifiers: Modifiers {
                ctrl: row.modifiers.command,
                ..row.modifiers
            },
        }
    }

    fn taken(events: Vec<Event>, typing: bool) -> (Vec<Wish>, usize) {
        let mut input = InputState::default();
        input.events = events;
        let wishes = consume_from(&mut input, typing, Escape::Stops);
        (wishes, input.events.len())
    }

    #[test]
    fn no_key_of_the_window_can_be_that_of_a_pose() {
        for row in ROWS.iter().filter(|row| row.modifiers == SHIFT) {
            let name = row.key.name().to_owned();
            assert!(EntryKey::try_from(name).is_err(), "{}", row.name());
        }
        let free = event(row(SHIFT, Key::F, Wish::Close), false);
        let (wishes, left) = taken(vec![free.clone()], false);
        let key = EntryKey::try_from("F".to_owned()).unwrap();
        assert_eq!((wishes, left), (vec![Wish::Entry(key)], 0));
        assert_eq!(taken(vec![free], true), (vec![], 1), "it is typed");
    }

    #[test]
    fn every_row_does_what_it_says_and_no_row_is_hidden_by_another() {
        for row in ROWS {
            let left = usize::from(row.key == Key::Escape);
            let wanted = (vec![row.wish], left);
            assert_eq!(taken(vec![event(row, false)], false), wanted, "{row:?}");
        }
    }

    #[test]
    fn a_held_key_asks_once_and_is_not_passed_on() {
        for row in ROWS.into_iter().filter(|row| row.key != Key::Escape) {
            assert_eq!(taken(vec![event(row, true)], false), (vec![], 0), "{row:?}");
        }
    }

    #[test]
    fn who_types_is_left_alone_but_for_escape() {
        for row in ROWS {
            let wanted = if row.key == Key::Escape {
                vec![Wish::Stop]
            } else {
                vec![]
            };
            assert_eq!(taken(vec![event(row, false)], true), (wanted, 1), "{row:?}");
        }
    }

    #[test]
    fn escape_goes_on_alone_where_it_closes_what_is_open_and_space_stops_still() {
        let mut input = InputState::default();
        input.events = [Key::Escape, Key::Space]
            .map(|key| event(row(NONE, key, Wish::Stop), false))
            .to_vec();
        let wishes = consume_from(&mut input, false, Escape::Closes);
        assert_eq!((wishes, input.events.len()), (vec![Wish::Stop], 1));
    }

    #[test]
    fn what_may_let_the_hand_move_wants_shift() {
        for row in ROWS {
            let moves = matches!(
                row.wish,
                Wish::ArmOrNot | Wish::Open | Wish::Half | Wish::Close
            );
            assert_eq!(
                moves,
                row.modifiers == SHIFT && row.key != Key::T,
                "{row:?}"
            );
        }
    }

    #[test]
    fn while_trials_run_any_key_is_a_stop_and_a_held_one_is_not() {
        let press = |repeat| row(NONE, Key::F7, Wish::Opens(ViewRequest::Keys)).pressed(repeat);
        for (events, wishes) in [
            (vec![press(false)], vec![Wish::Stop]),
            (vec![press(true)], vec![]),
            (vec![Event::Text("x".into())], vec![Wish::Stop]),
            (vec![Event::PointerGone], vec![]),
        ] {
            let mut input = InputState::default();
            input.events.clone_from(&events);
            assert_eq!(consume_any_from(&mut input), wishes, "{events:?}");
        }
    }

    impl KeyRow {
        fn pressed(self, repeat: bool) -> Event {
            event(self, repeat)
        }
    }

    #[test]
    fn a_stop_is_meant_whatever_is_held_down() {
        for key in [Key::Space, Key::Escape] {
            for modifiers in [Modifiers::SHIFT, Modifiers::CTRL, Modifiers::ALT] {
                let held = row(modifiers, key, Wish::Stop);
                assert_eq!(taken(vec![event(held, false)], false).0, [Wish::Stop]);
            }
        }
    }

    #[test]
    fn a_note_does_not_begin_with_its_own_key() {
        let note = ROWS
            .into_iter()
            .find(|row| row.wish == Wish::Opens(ViewRequest::Note));
        let events = note.map(|row| vec![event(row, false), Event::Text("n".into())]);
        assert_eq!(
            taken(events.unwrap_or_default(), false),
            (vec![Wish::Opens(ViewRequest::Note)], 0)
        );
    }

    #[test]
    fn keys_have_the_names_that_stand_on_them() {
        assert_eq!(Wish::Stop.keys(), "Space, Esc");
        assert_eq!(Wish::ArmOrNot.keys(), "Shift+A");
        assert_eq!(Wish::Opens(ViewRequest::Keys).keys(), "F1, ?");
        assert_eq!(Wish::Joint(Dof::Index).keys(), "4");
    }
}
