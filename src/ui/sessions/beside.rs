//! Choosing a second session that is drawn over the replayed one, and the marks at which both are aligned.

use crate::app::action::Action;
use crate::app::sessions::{BesideSession, SessionAction, SessionItem, Timeline};
use crate::hand::Moment;
use crate::record::EventKind;
use crate::record::file::FileMark;
use crate::ui::kit::{self, Button, Label, Look, Pane};
use crate::ui::sessions::marks::{clock, shown};
use crate::ui::text::sessions;
use egui::{Popup, PopupCloseBehavior, ScrollArea, Ui};

/// Sessions that are offered, the newest first.
const OFFERED: usize = 200;

/// Draws the choice, and once one is chosen its name and the marks.
pub(crate) fn beside_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let look = pane.look;
    let Some(beside) = &pane.state.beside else {
        let choose = Button::said(look, sessions::BESIDE).ui(ui, look);
        Popup::menu(&choose).show(|ui| offers_ui(ui, pane, line));
        return;
    };
    let off = Button::new(&beside.title, look.say(sessions::BESIDE_OFF));
    let name = look.pair(look.say(sessions::BESIDE_OFF), &beside.title);
    let off = off.named(&name).switch(true);
    off.on_click(ui, pane, Action::Session(SessionAction::Beside(None)));
    let align = Button::said(look, sessions::ALIGN).ui(ui, look);
    let stays = PopupCloseBehavior::CloseOnClickOutside;
    let menu = Popup::menu(&align).close_behavior(stays);
    menu.show(|ui| align_ui(ui, pane, line, beside));
}

fn offers_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let items = pane.state.sessions.items.iter();
    let others: Vec<&SessionItem> = items.filter(|item| item.path != line.path).collect();
    if others.is_empty() {
        Label::muted(pane.look, sessions::BESIDE_NONE).ui(ui);
    }
    ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
        for item in others.into_iter().take(OFFERED) {
            let title = sessions::title(pane.look, pane.state, item);
            if ui.button(title).on_hover_text(item.title()).clicked() {
                let beside = SessionAction::Beside(Some(item.path.clone()));
                pane.actions.push(Action::Session(beside));
            }
        }
    });
}

/// The moments of a session that it can be aligned at.
fn moments(look: Look, first: Moment, marks: &[FileMark]) -> Vec<(Moment, String)> {
    let beginning = (first, look.say(sessions::BEGINNING).to_owned());
    let marks = marks.iter().filter_map(|mark| {
        let word = match mark.kind {
            EventKind::Note => mark.words.clone(),
            kind => look.say(shown(look, kind)?.0).to_owned(),
        };
        let at = clock(mark.at.since(first));
        Some((mark.at, format!("{at}  {word}")))
    });
    std::iter::once(beginning).chain(marks).collect()
}

fn align_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline, beside: &BesideSession) {
    let look = pane.look;
    ui.set_min_width(280.0);
    let mut own = moments(look, line.first, &line.marks);
    own.push((line.at, look.say(sessions::THIS_MOMENT).to_owned()));
    let other = moments(look, beside.first, &beside.marks);
    let (mut at_own, mut at_other) = (beside.own, beside.other);
    let choose = |ui: &mut Ui, text, chosen: &mut Moment, all: &[(Moment, String)]| {
        ui.label(look.say(text));
        let all: Vec<(Moment, &str)> = all
            .iter()
            .map(|(at, words)| (*at, words.as_str()))
            .collect();
        kit::choose_ui(ui, look.say(text), chosen, &all)
    };
    let moved = choose(ui, sessions::ALIGN_OWN, &mut at_own, &own);
    let moved = choose(ui, sessions::ALIGN_OTHER, &mut at_other, &other) || moved;
    if moved {
        let align = SessionAction::Align(at_own, at_other);
        pane.actions.push(Action::Session(align));
    }
}
