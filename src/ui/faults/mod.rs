//! The view that explains the hand's state: six drives, present and past faults, advice, and the log. Clears nothing by itself.
pub(crate) mod entry;
pub(crate) mod message_log;
pub(crate) mod recording_events;
pub(crate) mod recordings;

use crate::app::action::Action;
use crate::app::readings::Freshness;
use crate::app::readings::faults::NothingToClear;
use crate::app::settings::Language;
use crate::hand::{Dof, Fault, Status, Words};
use crate::ui::faults::entry::{Depth, entry_ui, inset_ui, scroll_ui, seen_all_ui};
use crate::ui::faults::message_log::MessageLog;
use crate::ui::faults::recordings::FaultRecordingsView;
use crate::ui::kit::DriveWords;
use crate::ui::kit::{self, Button, Label, Pane, ViewRequest, Weight};
use crate::ui::text::{main, notices, panels, words};
use crate::ui::theme;
use egui::{CollapsingHeader, Margin, Panel, Ui};

/// View state.
#[derive(Debug, Default)]
pub(crate) struct FaultsView {
    /// Joint whose faults are highlighted.
    chosen: Option<Dof>,
    section: FaultSection,
    log: MessageLog,
    recordings: FaultRecordingsView,
}

/// List beside the faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum FaultSection {
    #[default]
    Log,
    Recordings,
}

impl FaultsView {
    /// Explains this joint's state and lists its faults first; `None` treats all joints alike.
    pub(crate) const fn choose(&mut self, dof: Option<Dof>) {
        self.chosen = dof;
        self.recordings.close();
    }

    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        if let Some(recording) = self.recordings.opened(pane) {
            kit::full_card_ui(ui, look, |ui| {
                self.recordings.recording_ui(ui, pane, &recording);
            });
            return;
        }
        kit::full_card_ui(ui, look, |ui| {
            let upper = (ui.available_height() * 0.55).round();
            let above = kit::bare(Panel::top("faults"), upper, Margin::ZERO);
            above.show(ui, |ui| self.faults_ui(ui, pane));
            ui.separator();
            ui.push_id("beside", |ui| self.beside_ui(ui, pane));
        });
    }

    fn faults_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::head_ui(ui, look, look.tr(main::TAB_FAULTS), |ui| {
            let shut = Button::text(look, notices::SHUT_FAULTS).icon(theme::CLOSE);
            let shut = shut.weight(Weight::Quiet);
            shut.navigate(ui, pane, ViewRequest::Faults);
            clear_ui(ui, pane);
            seen_all_ui(ui, pane);
        });
        scroll_ui(ui, |ui| {
            if let Some(dof) = self.chosen
                && drive_ui(ui, pane, dof)
            {
                self.chosen = None;
            }
            let mut entries = entry::steady(ui, pane, |_| true);
            entries.sort_by_key(|entry| self.chosen.is_some_and(|dof| entry.dof != dof));
            if entries.is_empty() {
                none_ui(ui, pane);
            }
            for entry in &entries {
                let depth = if self.chosen == Some(entry.dof) {
                    Depth::Chosen
                } else {
                    Depth::Whole
                };
                if let Some(id) = entry_ui(ui, pane, entry, depth) {
                    self.recordings.open(id);
                }
            }
            meanings_ui(ui, pane);
        });
    }

    /// Draws the messages, or the recordings.
    fn beside_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let recordings = match pane.hand().measured.recorder.iter().count() {
            0 => look.tr(notices::RECORDINGS).to_owned(),
            count => format!("{} ({count})", look.tr(notices::RECORDINGS)),
        };
        ui.horizontal(|ui| {
            for (text, section) in [
                (look.tr(notices::LOG), FaultSection::Log),
                (&recordings, FaultSection::Recordings),
            ] {
                let button = Button::new(text, look.tr(notices::SECTION_TIP));
                let button = button.choice(self.section == section);
                if button.ui(ui, look).clicked() {
                    self.section = section;
                }
            }
        });
        match self.section {
            FaultSection::Log => self.log.ui(ui, pane),
            FaultSection::Recordings => self.recordings.list_ui(ui, pane),
        }
    }
}

fn clear_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let hand = pane.hand();
    let reason = match hand.readings.faults.nothing_to_clear() {
        _ if !hand.connection.status.state.is_live() => Some(main::REFUSED_OFFLINE),
        _ if hand.readings.sample.faults.is_none() => Some(notices::CLEAR_UNREAD),
        Some(NothingToClear::NoFault) => Some(notices::CLEAR_NO_FAULT),
        Some(NothingToClear::OnlyHeat) => Some(notices::CLEAR_ONLY_HEAT),
        None => None,
    };
    let reason = reason.map(|reason| look.tr(reason));
    let button = Button::text(look, panels::CLEAR).disabled(reason);
    button.on_click(ui, pane, Action::ClearErrors);
}

/// Draws that there are no faults, or that this is unknown.
fn none_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let faults = pane.hand().readings.sample.faults;
    let asked = faults.map(|faults| faults.asked);
    let (text, color) = match pane.freshness(asked) {
        Freshness::Live => (panels::FAULTS_NONE, look.palette.ok),
        Freshness::Stale => (panels::FAULTS_NONE_OLD, look.palette.faint),
        Freshness::Unknown => (panels::FAULTS_UNKNOWN, look.palette.faint),
    };
    ui.horizontal(|ui| {
        kit::lamp_ui(ui, Some(color));
        Label::muted(look, text).ui(ui);
    });
    let hint = look.tr(panels::FAULTS_NONE_HINT);
    inset_ui(ui, |ui| kit::small_text_ui(ui, hint, look.palette.muted));
}

/// Explains the state of the chosen drive. True if the user closes the explanation.
fn drive_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof) -> bool {
    let look = pane.look;
    let palette = look.palette;
    let drive = DriveWords::of(pane, dof);
    let verb = match drive.freshness {
        Freshness::Live => notices::SAYS_NOW,
        _ => notices::SAID_LAST,
    };
    let joint = look.tr(words::dof(dof));
    let title = format!("{joint} · {}: {}", look.tr(verb), drive.title);
    let closed = ui.horizontal_wrapped(|ui| {
        kit::lamp_ui(ui, Some(drive.lamp));
        Label::new(&title, palette.text).ui(ui);
        let close = look.tr(notices::CHOSEN_CLOSE);
        let button = Button::new(close, "").weight(Weight::Quiet);
        button.ui(ui, look).clicked()
    });
    let sample = &pane.hand().readings.sample;
    let status = sample.status.map(|group| group.value[dof]);
    // A fault is explained by its entry below; the status is added here.
    let faulty = sample
        .faults
        .is_some_and(|group| !group.value[dof].is_empty());
    if let Some(status) = status.filter(|status| !(faulty && status.is_protective())) {
        let words = words::status(status, look.language);
        let advice = look.tr_with(notices::TODO, words.advice);
        inset_ui(ui, |ui| {
            kit::small_text_ui(ui, words.cause, palette.muted);
            kit::small_text_ui(ui, &advice, palette.text);
        });
    }
    closed.inner
}

/// Explains every code and bit of the manual, for new users.
fn meanings_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    ui.separator();
    let all = CollapsingHeader::new(look.tr(notices::MEANINGS)).id_salt("meanings");
    all.show_unindented(ui, |ui| {
        kit::small_text_ui(ui, look.tr(notices::MEANINGS_FAULT), look.palette.muted);
        for fault in (0..5).map(Fault::from_bit) {
            meaning_ui(ui, pane, words::fault(fault, look.language));
        }
        kit::small_text_ui(ui, look.tr(notices::MEANINGS_STATUS), look.palette.muted);
        for status in [0, 1, 2, 3, 5, 6, 7].map(Status::from_raw) {
            meaning_ui(ui, pane, words::status(status, look.language));
        }
    });
}

fn meaning_ui(ui: &mut Ui, pane: &Pane<'_>, words: Words) {
    let palette = pane.look.palette;
    let (cause, advice) = (words.cause, words.advice);
    let title = pane.look.pair(words.title, "");
    let body = match pane.look.language {
        Language::En => format!("{cause} {advice}"),
        Language::Zh => format!("{cause}{advice}"),
    };
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        kit::small_text_ui(ui, &title, palette.text);
        kit::small_text_ui(ui, &body, palette.muted);
    });
}
