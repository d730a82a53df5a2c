//! The view that compares trials: sessions, curves over each other, what was measured, the map of overshoot and the
//! best. Holds what is chosen, no trial.

use crate::app::action::Action;
use crate::app::state::State;
use crate::app::trials::{Comparison, SessionId, SessionOrigin, TrialAction, TrialSession};
use crate::ui::kit::path_field::path_ui;
use crate::ui::kit::{self, Button, ButtonRole, Card, Choice, Label, Look, Pane, TextField};
use crate::ui::text::{notices, tune};
use crate::ui::theme;
use crate::ui::trials::compare_best::BestView;
use crate::ui::trials::compare_choice::{ShownSessions, TrialKey};
use crate::ui::trials::compare_curves::CurvesView;
use crate::ui::trials::compare_list;
use crate::ui::trials::compare_list::SessionSheet;
use crate::ui::trials::compare_table::TableView;
use egui::{Color32, Panel, ScrollArea, Ui};

const NOTE_CHARS: usize = 300;

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct CompareView {
    chosen: ShownSessions,
    comparison: Option<Comparison>,
    curves: CurvesView,
    table: TableView,
    /// The trial that stands out.
    strong: Option<TrialKey>,
    best: BestView,
}

impl CompareView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let trials = &pane.state.trials;
        self.chosen.follow(&trials.sessions);
        kit::card_ui(ui, look, |ui| {
            ui.set_min_height(ui.available_height());
            let focus = self.chosen.focus.and_then(|id| trials.session(id));
            ui.horizontal(|ui| self.head_ui(ui, pane, focus));
            let (told, color) = told(pane.state, look, focus);
            Label::new(&told, color).small().ui(ui);
            if trials.asks_path
                && let Some(path) = path_ui(ui, look, "session")
            {
                pane.actions
                    .push(Action::Trial(TrialAction::Open(Some(path))));
            }
            let Some(focus) = focus else {
                ui.centered_and_justified(|ui| {
                    Label::muted(look, tune::COMPARE_EMPTY).ui(ui);
                });
                return;
            };
            compare_list::list_ui(ui, SessionSheet { look, trials }, &mut self.chosen);
            let focus = self
                .chosen
                .focus
                .and_then(|id| trials.session(id))
                .unwrap_or(focus);
            self.sessions_ui(ui, pane, focus);
        });
    }

    /// Curves and best over the table.
    fn sessions_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, focus: &TrialSession) {
        let comparison = self.comparison(pane, focus.id);
        let room = ui.available_size();
        let table = Panel::bottom("trial table");
        kit::bare(table, room.y * 0.48, theme::GAP_TOP).show(ui, |ui| {
            let replay = self.table.ui(ui, pane, &comparison, &mut self.strong);
            pane.actions.extend(replay.map(Action::Session));
        });
        let width = (room.x * 0.36).clamp(256.0, 440.0);
        kit::bare(Panel::right("best"), width, theme::GAP_LEFT).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                self.best.ui(ui, pane, &comparison, focus);
            });
        });
        self.curves.ui(ui, pane, &comparison, &mut self.strong);
        self.comparison = Some(comparison);
    }

    /// The sessions side by side: reckoned again only when they changed.
    fn comparison(&mut self, pane: &Pane<'_>, focus: SessionId) -> Comparison {
        let trials = &pane.state.trials;
        let shown = &self.chosen.shown;
        let former = self.comparison.take();
        if let Some(former) = former.filter(|own| own.stands(trials, shown, focus)) {
            return former;
        }
        self.curves.forget();
        self.table.forget();
        Comparison::of(trials, shown, focus)
    }

    /// Note, tags and files of the session at hand.
    fn head_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, now: Option<&TrialSession>) {
        let look = pane.look;
        let none = now.is_none().then(|| look.say(tune::COMPARE_EMPTY));
        let id = now.map(|own| own.id);
        let runs = id.is_some() && id == pane.state.trials.running;
        let busy = none.or(runs.then(|| look.say(tune::SAVE_RUNS)));
        let read = now.filter(|own| matches!(own.origin, SessionOrigin::Folder(_)));
        let read = read.map(|_| look.say(tune::SAVE_READ));
        let save = id.map(|id| TrialAction::Save(id, Some(self.best.criterion())));
        let forget = id.map(TrialAction::Forget);
        kit::right_ui(ui, |ui| {
            for (text, disabled, action) in [
                (tune::FORGET, busy, forget),
                (tune::SAVE, busy.or(read), save),
                (tune::OPEN, None, Some(TrialAction::Open(None))),
            ] {
                let button = Button::said(look, text).disabled(disabled);
                if button.ui(ui, look).clicked() {
                    pane.actions.extend(action.map(Action::Trial));
                }
            }
            if let Some(own) = now {
                kit::left_ui(ui, |ui| self.words_ui(ui, pane, own));
            }
        });
    }

    fn words_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, session: &TrialSession) {
        let look = pane.look;
        let (id, head) = (session.id, &session.head);
        let tags = head.tags.join(", ");
        let half = (ui.available_width() - theme::GAP) / 2.0;
        let note = TrialAction::Note as fn(SessionId, String) -> TrialAction;
        for (name, value, action) in [
            (tune::NOTE, &head.note, note),
            (tune::TAGS, &tags, TrialAction::Tags),
        ] {
            let field = TextField::new(look.say(name), NOTE_CHARS).hint(look.tip(name));
            ui.push_id((id, name.en), |ui| {
                ui.set_max_width(half);
                if let Some(text) = field.ui(ui, pane, value) {
                    pane.actions.push(Action::Trial(action(id, text)));
                }
            });
        }
    }
}

/// What became of the last wish about files, else where the session at hand lies.
pub(crate) fn told(state: &State, look: Look, now: Option<&TrialSession>) -> (String, Color32) {
    let palette = look.palette;
    if let Some(refused) = &state.trials.refused {
        return (notices::notice(look, refused), palette.warn);
    }
    match now.map(|own| &own.origin) {
        None => (String::new(), palette.muted),
        Some(SessionOrigin::Unsaved) => (look.say(tune::NOT_SAVED).into(), palette.muted),
        Some(SessionOrigin::Saved(place)) => {
            (look.fill(tune::SAVED_IN, &[&place.display()]), palette.ok)
        }
        Some(SessionOrigin::Folder(place)) => {
            let words = look.fill(tune::READ_FROM, &[&place.display()]);
            (words, palette.muted)
        }
    }
}

/// The card of a session that is about to go and lies in no file.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let session = state.trials.session(state.trials.to_confirm?)?;
    let loses = look.fill(tune::FORGET_LOSES, &[&session.trials.len()]);
    let back = Choice::new(tune::FORGET_NOT, ButtonRole::Safe);
    let forget = Choice::new(tune::FORGET_SURE, ButtonRole::Danger);
    let card = Card::new(look, tune::FORGET_TITLE)
        .words(compare_list::name(look, session.id))
        .warning(loses)
        .choice(back.does(Action::Trial(TrialAction::CancelForget)))
        .choice(forget.does(Action::Trial(TrialAction::ConfirmForget)));
    Some(card)
}
