//! The trials of a replayed recording: a list in place of the plan, which belongs to the live hand. A click goes to a trial.

use crate::app::action::Action;
use crate::app::recordings::{RecordingAction, Timeline};
use crate::hand::Dof;
use crate::record::EventKind;
use crate::record::file::FileMark;
use crate::ui::kit::{self, Button, Label, Look, Pane};
use crate::ui::recordings::marks::clock;
use crate::ui::text::{recordings, words};
use egui::{ScrollArea, Ui};

/// Draws the trials of a recording as a list.
pub(crate) fn list_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let look = pane.look;
    kit::full_card_ui(ui, look, |ui| {
        kit::head_ui(ui, look, look.tr(recordings::TRIALS), |_| ());
        let marks = line.marks.iter();
        let trials: Vec<_> = marks.filter(|mark| mark.kind == EventKind::Trial).collect();
        if trials.is_empty() {
            Label::muted(look, recordings::NO_TRIALS).wrap().ui(ui);
            return;
        }
        let height = ui.spacing().interact_size.y;
        let area = ScrollArea::vertical().auto_shrink(false);
        area.show_rows(ui, height, trials.len(), |ui, rows| {
            for mark in trials.get(rows).unwrap_or_default() {
                let clock = clock(mark.at.since(line.first));
                let text = format!("{clock}  {}", trial_words(look, mark));
                let seek = Action::Recording(RecordingAction::Seek(mark.at));
                let button = Button::new(&text, look.tip(recordings::TRIALS));
                button.on_click(ui, pane, seek);
            }
        });
    });
}

/// `2 / 4, Index` of the event `2 of 4, index`.
fn trial_words(look: Look, mark: &FileMark) -> String {
    let parts = mark.words.split(", ").map(|part| {
        let dof = Dof::ALL.into_iter().find(|dof| dof.name() == part);
        dof.map_or_else(
            || part.replace(" of ", " / "),
            |dof| look.tr(words::dof(dof)).to_owned(),
        )
    });
    let parts: Vec<String> = parts.collect();
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    look.list(&parts)
}
