//! List of the user's notes: a click shows the moment of a note, and each can be deleted.

use crate::app::action::Action;
use crate::history::{Mark, MarkKind};
use crate::ui::kit::{Button, Pane, Weight};
use crate::ui::plots::times::clock;
use crate::ui::text::panels;
use crate::ui::theme;
use egui::{ScrollArea, Ui};

/// Characters of a note in the list; the tooltip has the rest.
const SHOWN: usize = 28;

/// Draws the list, newest first, if there are any notes. Returns the moment to show, in seconds.
pub(crate) fn notes_ui(ui: &mut Ui, pane: &mut Pane<'_>) -> Option<f64> {
    let history = &pane.hand().measured.history;
    let all = history.marks(f64::NEG_INFINITY, f64::INFINITY);
    let mut notes: Vec<(&Mark, &str)> = all
        .filter_map(|mark| match &mark.kind {
            MarkKind::Note(words) => Some((mark, words.as_ref())),
            _ => None,
        })
        .collect();
    notes.reverse();
    if notes.is_empty() {
        return None;
    }
    let look = pane.look;
    ui.label(look.tr(panels::NOTES));
    let mut asked = None;
    let list = ScrollArea::vertical().id_salt("notes").max_height(180.0);
    list.show(ui, |ui| {
        for (mark, words) in notes {
            ui.horizontal(|ui| {
                let name = look.pair(look.tr(panels::NOTE_DELETE), words);
                let delete = Button::text(look, panels::NOTE_DELETE);
                let delete = delete.icon(theme::CLOSE).weight(Weight::Quiet);
                if delete.named(&name).ui(ui, look).clicked() {
                    pane.actions.push(Action::RemoveMark(mark.clone()));
                }
                let short: String = words.chars().take(SHOWN).collect();
                let text = format!("{}  {short}", clock(mark.at.secs(), 0.01));
                let tip = format!("{words}\n{}", look.tip(panels::NOTE_SHOW));
                if ui.button(text).on_hover_text(tip).clicked() {
                    asked = Some(mark.at.secs());
                }
            });
        }
    });
    ui.separator();
    asked
}
