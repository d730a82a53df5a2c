//! The view of recordings: finding, naming, starring, replaying, exporting and deleting them.
pub(crate) mod beside;
pub(crate) mod marks;
pub(crate) mod stretch;
pub(crate) mod strip;
pub(crate) mod table;

use crate::app::action::Action;
use crate::app::hand::Hand;
use crate::app::recordings::{RecordingAction, RecordingItem};
use crate::app::state::State;
use crate::ui::hand::tile;
use crate::ui::kit::path_field::{folder_path_ui, path_ui};
use crate::ui::kit::{
    self, Button, ButtonRole, Card, CardButton, Label, Look, Pane, ViewRequest, Weight, format,
};
use crate::ui::recordings::table::{MarkedStretch, RecordingTable};
use crate::ui::text::recordings;
use crate::ui::theme;
use crate::ui::view::View;
use egui::{Frame, Panel, ProgressBar, Ui};
use std::path::Path;
use std::time::Duration;

/// Interval at which the folder is listed while the view is open: other programs record, too.
const POLL_INTERVAL: Duration = Duration::from_secs(5);
/// Repaint interval of an export's progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// View state.
#[derive(Debug, Default)]
pub(crate) struct RecordingsView {
    find: String,
    /// Time of the last listing, in seconds of the window's time.
    scanned_s: Option<f64>,
    /// The field for another file is open.
    other: bool,
    /// Time range marked on a strip.
    marked: Option<MarkedStretch>,
}

impl RecordingsView {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let now = ui.input(|input| input.time);
        if self
            .scanned_s
            .is_none_or(|at| now - at >= POLL_INTERVAL.as_secs_f64())
        {
            self.scanned_s = Some(now);
            pane.actions
                .push(Action::Recording(RecordingAction::Refresh));
            ui.ctx().request_repaint_after(POLL_INTERVAL);
        }
        kit::full_card_ui(ui, pane.look, |ui| {
            self.head_ui(ui, pane);
            if self.other
                && let Some(path) = path_ui(ui, pane.look, "session")
            {
                let open = RecordingAction::Open(path);
                pane.actions.push(Action::Recording(open));
            }
            folder_ui(ui, pane);
            foot_ui(ui, pane);
            if !pane.state.recordings.exports.is_empty() {
                // Below the list, so that its rows stay under the pointer.
                let foot = Panel::bottom("exports").resizable(false);
                let foot = foot.show_separator_line(false).frame(Frame::NONE);
                foot.show(ui, |ui| exports_ui(ui, pane));
            }
            self.list_ui(ui, pane);
        });
    }

    /// Called when the user leaves the view: the list is refreshed when it is next shown.
    pub(crate) const fn leave(&mut self) {
        self.scanned_s = None;
    }

    fn head_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::head_ui(ui, look, look.tr(recordings::TITLE), |ui| {
            let other = Button::text(look, recordings::OPEN_OTHER).switch(self.other);
            other.toggle(ui, look, &mut self.other);
            let mut simulated = pane.state.settings.recordings.record_simulated;
            if kit::tick_ui(ui, look, recordings::SIM_TOO, &mut simulated) {
                let action = RecordingAction::RecordSimulated(simulated);
                pane.actions.push(Action::Recording(action));
            }
            ui.scope(|ui| {
                ui.set_max_width(260.0);
                kit::translated_edit_ui(ui, look, recordings::FIND, &mut self.find);
            });
        });
    }

    fn list_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let state = &pane.state.recordings;
        let all = state.items.iter();
        let shown: Vec<&RecordingItem> = all.filter(|item| item.matches(&self.find)).collect();
        let empty = match (state.items.is_empty(), shown.is_empty()) {
            (true, _) if state.is_scanning || state.scans == 0 && state.folder.is_some() => {
                Some(recordings::LOOKS)
            }
            (true, _) => return empty_ui(ui, pane),
            (false, true) => Some(recordings::FIND_NONE),
            (false, false) => None,
        };
        match empty {
            Some(text) => {
                Label::muted(look, text).wrap().ui(ui);
            }
            None => {
                let marked = &mut self.marked;
                RecordingTable { marked }.ui(ui, pane, &shown);
            }
        }
    }
}

/// Draws the page of an empty list: a picture, a hint on automatic recording, and one action.
fn empty_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    ui.vertical_centered(|ui| {
        tile::empty_page_ui(ui, look, 0.5, recordings::NONE_TITLE);
        if pane.state.recordings.folder.is_none() {
            Label::muted(look, recordings::NOWHERE).wrap().ui(ui);
            ui.add_space(theme::GAP);
            let choose = Button::text(look, recordings::FOLDER_CHANGE);
            let choose = choose.weight(Weight::Strong).large();
            let action = RecordingAction::ChooseFolder(None);
            return choose.on_click(ui, pane, Action::Recording(action));
        }
        Label::muted(look, recordings::NONE).wrap().ui(ui);
        ui.add_space(theme::GAP);
        let hand = pane.hand();
        if hand.connection.endpoint.is_some() {
            let record = Button::text(look, recordings::NONE_RECORD).large();
            let record = record.weight(Weight::Strong);
            return record.on_click(ui, pane, toggle_recording(hand));
        }
        let connect = Button::text(look, recordings::NONE_BUTTON).large();
        let connect = connect.weight(Weight::Strong);
        connect.navigate(ui, pane, ViewRequest::View(View::Connection));
    });
}

/// Begins or ends the recording of a hand.
pub(crate) fn toggle_recording(hand: &Hand) -> Action {
    let on = hand.recording.is_none();
    Action::Recording(if hand.connection.is_simulated() {
        RecordingAction::RecordSimulated(on)
    } else {
        RecordingAction::Record(on)
    })
}

/// Draws the exports in progress.
fn exports_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    for running in &pane.state.recordings.exports {
        let name = title_of(look, pane.state, &running.export.path);
        let format = look.tr(recordings::export_format(running.export.format));
        let name = look.pair(&name, format);
        let words = look.fill(recordings::EXPORTING, &[&name, &running.percent]);
        ui.horizontal(|ui| {
            let bar = ProgressBar::new(f32::from(running.percent) / 100.0);
            ui.add(bar.desired_width(160.0).desired_height(theme::GAP));
            Label::new(&words, look.palette.text).small().ui(ui);
        });
        ui.ctx().request_repaint_after(PROGRESS_INTERVAL);
    }
}

/// Draws the folder of the recordings, and the buttons that change it.
fn folder_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    ui.horizontal(|ui| {
        kit::right_ui(ui, |ui| {
            let is_default = pane.state.settings.recordings.folder.is_none();
            let default = Button::text(look, recordings::FOLDER_DEFAULT);
            let default = default.disabled_if(is_default, look.tr(recordings::FOLDER_IS_DEFAULT));
            let action = Action::Recording(RecordingAction::DefaultFolder);
            default.on_click(ui, pane, action);
            let change = Button::text(look, recordings::FOLDER_CHANGE);
            let action = Action::Recording(RecordingAction::ChooseFolder(None));
            change.on_click(ui, pane, action);
            kit::left_ui(ui, |ui| {
                Label::muted(look, recordings::FOLDER).ui(ui);
                let folder = pane.state.recordings.folder.as_ref();
                let folder = folder.map(|folder| folder.display().to_string());
                let folder = folder.unwrap_or_else(|| "-".into());
                let label = Label::new(&folder, look.palette.text);
                let label = label.named(look.tr(recordings::FOLDER)).ui(ui);
                label.on_hover_text(look.tip(recordings::FOLDER));
            });
        });
    });
    if pane.state.recordings.asks_folder
        && let Some(path) = folder_path_ui(ui, look)
    {
        let choose = RecordingAction::ChooseFolder(Some(path));
        pane.actions.push(Action::Recording(choose));
    }
}

/// Draws the disk space used, and the recordings that may be deleted.
fn foot_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let state = &pane.state.recordings;
    if state.items.is_empty() && state.unread.is_empty() {
        return;
    }
    let bytes: u64 = state.items.iter().map(|item| item.bytes).sum();
    let budget = pane.state.settings.recordings.budget_gb;
    let used = format::size(bytes);
    ui.horizontal_wrapped(|ui| {
        let total = look.fill(recordings::TOTAL, &[&state.items.len(), &used, &budget]);
        Label::new(&total, look.palette.muted).small().ui(ui);
        if !state.unread.is_empty() {
            let words = look.fill(recordings::UNREAD, &[&state.unread.len()]);
            let why = state.unread.iter().take(8);
            let why = why.map(|(path, why)| format!("{}: {why}", path.display()));
            let why: Vec<String> = why.collect();
            let label = Label::new(&words, look.palette.warn).small().ui(ui);
            label.on_hover_text(why.join("\n"));
        }
        planned_ui(ui, pane);
    });
}

/// Draws the recordings due for deletion, and a way to prevent it.
fn planned_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, state) = (pane.look, &pane.state.recordings);
    let Some(first) = state.planned.iter().min_by_key(|one| one.due_unix_s()) else {
        return;
    };
    let count = state.planned.len();
    let size = format::size(state.planned.iter().map(|one| one.bytes).sum());
    let words = look.fill(recordings::BEYOND, &[&count, &size, &first.due()]);
    Label::new(&words, look.palette.warn).small().ui(ui);
    for (text, action) in [
        (recordings::ROOM_KEEP, RecordingAction::KeepPlanned),
        (recordings::ROOM_NOW, RecordingAction::MakeRoom),
    ] {
        Button::text(look, text).on_click(ui, pane, Action::Recording(action));
    }
}

/// Card that confirms deleting a recording.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let path = state.recordings.to_delete.as_ref()?;
    let words = look.fill(recordings::DELETE_WHAT, &[&title_of(look, state, path)]);
    let [keep, delete] = [RecordingAction::KeepIt, RecordingAction::Delete].map(Action::Recording);
    let back = CardButton::new(recordings::DELETE_NOT, ButtonRole::Safe, keep);
    let delete = CardButton::new(recordings::DELETE_SURE, ButtonRole::Danger, delete);
    let card = Card::new(look, recordings::DELETE_TITLE).warning(words);
    Some(card.choice(back).choice(delete))
}

/// Title of the recording with this path.
fn title_of(look: Look, state: &State, path: &Path) -> String {
    let mut items = state.recordings.items.iter();
    let item = items.find(|item| item.path == path);
    item.map_or_else(
        || path.display().to_string(),
        |item| recordings::title(look, state, item),
    )
}
