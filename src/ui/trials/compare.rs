//! The view that compares trials: sessions, curves over each other, what was measured, the map of overshoot and the
//! best. Holds what is chosen, no trial.

use crate::app::action::Action;
use crate::app::state::State;
use crate::app::trials::{Comparison, SessionId, SessionOrigin, TrialAction, TrialSession};
use crate::ui::kit::card::{Card, Choice, Line, Manner};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right, take_top};
use crate::ui::kit::look::{Look, Pane};
use crate::ui::kit::text_field::TextField;
use crate::ui::text::{compare, tune};
use crate::ui::theme;
use crate::ui::trials::compare_best::BestView;
use crate::ui::trials::compare_choice::{ShownSessions, TrialKey};
use crate::ui::trials::compare_curves::CurvesView;
use crate::ui::trials::compare_list;
use crate::ui::trials::compare_list::Sheet;
use crate::ui::trials::compare_table::TableView;
use egui::{Id, Rect, Ui, UiBuilder};

/// Characters of a note.
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
    typed: Option<(Id, String)>,
}

impl CompareView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let trials = &pane.state.trials;
        self.chosen.follow(&trials.sessions);
        let mut body = controls::card(ui, look, rect);
        let focus = self.chosen.focus.and_then(|id| trials.session(id));
        self.head_ui(ui, take_top(&mut body, theme::CONTROL), pane, focus);
        let Some(focus) = focus else {
            Label::new(look.say(tune::COMPARE_EMPTY), look.palette.muted)
                .center()
                .put(ui, body);
            return;
        };
        let sheet = Sheet { look, trials };
        compare_list::list_ui(ui, &mut body, sheet, &mut self.chosen);
        let comparison = self.comparison(pane, focus.id);
        let curves = body.height() * theme::CURVES_SHARE;
        let mut upper = take_top(&mut body, curves);
        let width = (upper.width() * theme::MAP_SHARE).clamp(theme::MAP_LEAST, theme::MAP_MOST);
        let side = take_right(&mut upper, width);
        let place = UiBuilder::new().max_rect(upper);
        ui.scope_builder(place, |ui| {
            self.curves.ui(ui, pane, &comparison, &mut self.strong)
        });
        self.best.ui(ui, side, pane, &comparison, focus);
        self.table.ui(ui, body, pane, &comparison, &mut self.strong);
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
    fn head_ui(
        &mut self,
        ui: &mut Ui,
        mut row: Rect,
        pane: &mut Pane<'_>,
        now: Option<&TrialSession>,
    ) {
        let look = pane.look;
        let runs = pane.state.hand().series.as_ref().map(|run| run.session);
        let none = now.is_none().then(|| look.say(tune::COMPARE_EMPTY));
        let id = now.map(|own| own.id);
        let busy = (id.is_some() && id == runs).then(|| look.say(tune::SAVE_RUNS));
        let busy = none.or(busy);
        let read = now.filter(|own| matches!(own.origin, SessionOrigin::Folder(_)));
        let read = read.map(|_| look.say(tune::SAVE_READ));
        let save = id.map(|id| TrialAction::Save(id, Some(self.best.criterion())));
        let forget = id.map(TrialAction::Forget);
        for (text, tip, disabled, action) in [
            (compare::FORGET, compare::FORGET_TIP, busy, forget),
            (tune::SAVE, tune::SAVE_TIP, busy.or(read), save),
            (tune::OPEN, tune::OPEN_TIP, None, Some(TrialAction::Open)),
        ] {
            let words = look.say(text);
            let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
            let place = take_right(&mut row, width);
            let button = Button::new(words, look.say(tip)).disabled(disabled);
            let clicked = button.put(ui, look, place, Id::unique(("compare", text.en)));
            let action = action.filter(|_| clicked.clicked());
            pane.actions.extend(action.map(Action::Trial));
        }
        if let Some(own) = now {
            self.words_ui(ui, row, pane, own);
        }
    }

    fn words_ui(
        &mut self,
        ui: &mut Ui,
        mut row: Rect,
        pane: &mut Pane<'_>,
        session: &TrialSession,
    ) {
        let look = pane.look;
        let tags = session.head.tags.join(", ");
        let half = (row.width() - theme::GAP) / 2.0;
        let id = session.id;
        for (name, hint, value, action) in [
            (
                tune::NOTE,
                tune::NOTE_HINT,
                &session.head.note,
                TrialAction::Note as fn(SessionId, String) -> TrialAction,
            ),
            (tune::TAGS, tune::TAGS_HINT, &tags, TrialAction::Tags),
        ] {
            let field = TextField {
                name: look.say(name),
                hint: look.say(hint),
                value,
                max: NOTE_CHARS,
            };
            let place = take_left(&mut row, half);
            let field_id = Id::unique(("session text", id, name.en));
            if let Some(text) = field.put(ui, &mut self.typed, place, field_id) {
                pane.actions.push(Action::Trial(action(id, text)));
            }
        }
    }
}

/// The card of a session that is about to go and lies in no file.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let session = state.trials.session(state.trials.to_confirm?)?;
    let trials = session.trials.len();
    let loses = format!("{} {trials}", look.say(compare::FORGET_LOSES));
    let back = Choice::new(compare::FORGET_NOT, compare::FORGET_NOT_TIP, Manner::Safe);
    let forget = Choice::new(compare::FORGET_SURE, compare::FORGET_TIP, Manner::Danger);
    Some(Card {
        title: look.say(compare::FORGET_TITLE).into(),
        lines: vec![
            Line::Words(compare_list::name(look, session.id)),
            Line::Warning(loses),
        ],
        choices: vec![
            back.does(Action::Trial(TrialAction::CancelForget)),
            forget.does(Action::Trial(TrialAction::ConfirmForget)),
        ],
        ..Card::default()
    })
}
