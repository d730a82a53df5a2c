//! Selecting a second recording to draw over the replayed one, and the marks at which the two are aligned.

use crate::app::action::Action;
use crate::app::recordings::{BesideRecording, RecordingAction, RecordingItem, Timeline};
use crate::hand::Moment;
use crate::record::EventKind;
use crate::record::file::FileMark;
use crate::ui::kit::{self, Button, Label, Look, Pane};
use crate::ui::recordings::marks::{clock, shown};
use crate::ui::text::recordings;
use egui::{Popup, ScrollArea, Ui};

/// Maximum number of recordings offered, newest first.
const OFFERED: usize = 200;

/// Draws the choice, or the chosen recording's name with the marks.
pub(crate) fn beside_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let look = pane.look;
    let Some(beside) = &pane.state.beside else {
        let choose = Button::text(look, recordings::BESIDE).ui(ui, look);
        Popup::menu(&choose).show(|ui| offers_ui(ui, pane, line));
        return;
    };
    let off = Button::new(&beside.title, look.tr(recordings::BESIDE_OFF));
    let name = look.pair(look.tr(recordings::BESIDE_OFF), &beside.title);
    let off = off.named(&name).switch(true);
    off.on_click(ui, pane, Action::Recording(RecordingAction::Beside(None)));
    let align = Button::text(look, recordings::ALIGN).ui(ui, look);
    kit::lasting_popup(&align).show(|ui| align_ui(ui, pane, line, beside));
}

fn offers_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let items = pane.state.recordings.items.iter();
    let others: Vec<&RecordingItem> = items.filter(|item| item.path != line.path).collect();
    if others.is_empty() {
        Label::muted(pane.look, recordings::BESIDE_NONE).ui(ui);
    }
    ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
        for item in others.into_iter().take(OFFERED) {
            let title = recordings::title(pane.look, pane.state, item);
            if ui.button(title).on_hover_text(item.title()).clicked() {
                let beside = RecordingAction::Beside(Some(item.path.clone()));
                pane.actions.push(Action::Recording(beside));
            }
        }
    });
}

/// Moments at which a recording can be aligned.
fn moments(look: Look, first: Moment, marks: &[FileMark]) -> Vec<(Moment, String)> {
    let beginning = (first, look.tr(recordings::BEGINNING).to_owned());
    let marks = marks.iter().filter_map(|mark| {
        let word = match mark.kind {
            EventKind::Note => mark.words.clone(),
            kind => look.tr(shown(look, kind)?.0).to_owned(),
        };
        let at = clock(mark.at.since(first));
        Some((mark.at, format!("{at}  {word}")))
    });
    std::iter::once(beginning).chain(marks).collect()
}

fn align_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline, beside: &BesideRecording) {
    let look = pane.look;
    ui.set_min_width(280.0);
    let mut own = moments(look, line.first, &line.marks);
    own.push((line.at, look.tr(recordings::THIS_MOMENT).to_owned()));
    let other = moments(look, beside.first, &beside.marks);
    let (mut at_own, mut at_other) = (beside.own, beside.other);
    let choose = |ui: &mut Ui, text, chosen: &mut Moment, all: &[(Moment, String)]| {
        ui.label(look.tr(text));
        kit::choose_ui(ui, look.tr(text), chosen, all)
    };
    let moved = choose(ui, recordings::ALIGN_OWN, &mut at_own, &own);
    let moved = choose(ui, recordings::ALIGN_OTHER, &mut at_other, &other) || moved;
    if moved {
        let align = RecordingAction::Align(at_own, at_other);
        pane.actions.push(Action::Recording(align));
    }
}
