//! The view that compares trials: sessions, curves over each other, what was measured, the map of overshoot and the
//! best. Holds what is chosen, no trial.

use crate::app::action::Action;
use crate::app::state::State;
use crate::app::tuner::{Comparison, Origin, Session, SessionId, TrialWish};
use crate::ui::card::{Card, Choice, Line, Manner};
use crate::ui::compare_best::BestView;
use crate::ui::compare_curves::CurvesView;
use crate::ui::compare_list::{self, Sheet};
use crate::ui::compare_table::TableView;
use crate::ui::controls::{self, Button, Label, take_left, take_right, take_top};
use crate::ui::look::{Look, Pane};
use crate::ui::text::{compare, tune};
use crate::ui::text_field::TextField;
use crate::ui::theme;
use egui::{Id, Rect, Ui};

/// Characters of a note.
const NOTE_CHARS: usize = 300;

/// A trial of a session.
pub(crate) type Strong = Option<(SessionId, usize)>;

/// The sessions that are shown, and the one whose words and files are at hand.
#[derive(Debug, Default)]
pub(crate) struct Chosen {
    /// Over each other, the oldest first.
    pub(crate) shown: Vec<SessionId>,
    /// One of them.
    pub(crate) focus: Option<SessionId>,
    newest: Option<SessionId>,
}

impl Chosen {
    /// What was begun or opened last is shown at once; what is not there any more is not.
    fn follow(&mut self, sessions: &[Session]) {
        let newest = sessions.iter().map(|session| session.id).max();
        let is_new = newest > self.newest;
        self.newest = newest.max(self.newest);
        self.shown
            .retain(|id| sessions.iter().any(|own| own.id == *id));
        if is_new || self.shown.is_empty() {
            self.shown = newest.into_iter().collect();
        }
        let is_shown = |id: &SessionId| self.shown.contains(id);
        self.focus = self.focus.filter(is_shown);
        self.focus = self.focus.or(self.shown.last().copied());
    }

    /// Makes a session the one at hand; alone, unless it is shown with others.
    pub(crate) fn choose(&mut self, id: SessionId) {
        if !self.shown.contains(&id) {
            self.shown = vec![id];
        }
        self.focus = Some(id);
    }

    /// Puts a session over the others or takes it away. The last one stays.
    pub(crate) fn toggle(&mut self, id: SessionId) {
        if !self.shown.contains(&id) {
            self.shown.push(id);
            self.shown.sort_unstable();
        } else if self.shown.len() > 1 {
            self.shown.retain(|own| *own != id);
            self.focus = self.focus.filter(|focus| *focus != id);
        }
    }
}

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct CompareView {
    chosen: Chosen,
    comparison: Option<Comparison>,
    curves: CurvesView,
    table: TableView,
    /// The trial that stands out.
    strong: Strong,
    best: BestView,
    typed: Option<(Id, String)>,
}

impl CompareView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let book = &pane.state.tuner;
        self.chosen.follow(&book.sessions);
        let mut body = controls::card(ui, look, rect);
        let focus = self.chosen.focus.and_then(|id| book.session(id));
        self.head_ui(ui, take_top(&mut body, theme::CONTROL), pane, focus);
        let Some(focus) = focus else {
            Label::new(look.say(tune::COMPARE_EMPTY), look.palette.muted)
                .center()
                .put(ui, body);
            return;
        };
        let sheet = Sheet { look, book };
        compare_list::list_ui(ui, &mut body, sheet, &mut self.chosen);
        let comparison = self.comparison(pane, focus.id);
        let curves = body.height() * theme::CURVES_SHARE;
        let mut upper = take_top(&mut body, curves);
        let width = (upper.width() * theme::MAP_SHARE).clamp(theme::MAP_LEAST, theme::MAP_MOST);
        let side = take_right(&mut upper, width);
        self.curves
            .ui(ui, upper, pane, &comparison, &mut self.strong);
        self.best.ui(ui, side, pane, &comparison, focus);
        self.table.ui(ui, body, pane, &comparison, &mut self.strong);
        self.comparison = Some(comparison);
    }

    /// The sessions side by side: reckoned again only when they changed.
    fn comparison(&mut self, pane: &Pane<'_>, focus: SessionId) -> Comparison {
        let book = &pane.state.tuner;
        let shown = &self.chosen.shown;
        let former = self.comparison.take();
        if let Some(former) = former.filter(|own| own.stands(book, shown, focus)) {
            return former;
        }
        self.curves.forget();
        self.table.forget();
        Comparison::of(book, shown, focus)
    }

    /// Note, tags and files of the session at hand.
    fn head_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, now: Option<&Session>) {
        let look = pane.look;
        let runs = pane.state.tuner.run.as_ref().map(|run| run.session);
        let none = now.is_none().then(|| look.say(tune::COMPARE_EMPTY));
        let id = now.map(|own| own.id);
        let busy = (id.is_some() && id == runs).then(|| look.say(tune::SAVE_RUNS));
        let busy = none.or(busy);
        let read = now.filter(|own| matches!(own.origin, Origin::Folder { .. }));
        let read = read.map(|_| look.say(tune::SAVE_READ));
        let save = id.map(|id| TrialWish::Save(id, Some(self.best.criterion())));
        let forget = id.map(TrialWish::Forget);
        for (text, tip, disabled, wish) in [
            (compare::FORGET, compare::FORGET_TIP, busy, forget),
            (tune::SAVE, tune::SAVE_TIP, busy.or(read), save),
            (tune::OPEN, tune::OPEN_TIP, None, Some(TrialWish::Open)),
        ] {
            let words = look.say(text);
            let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
            let place = take_right(&mut row, width);
            let button = Button::new(words, look.say(tip)).disabled(disabled);
            let clicked = button.put(ui, look, place, Id::unique(("compare", text.en)));
            let wish = wish.filter(|_| clicked.clicked());
            pane.actions.extend(wish.map(Action::Trial));
        }
        if let Some(own) = now {
            self.words_ui(ui, row, pane, own);
        }
    }

    fn words_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, session: &Session) {
        let look = pane.look;
        let tags = session.head.tags.join(", ");
        let half = (row.width() - theme::GAP) / 2.0;
        let id = session.id;
        for (name, hint, value, wish) in [
            (
                tune::NOTE,
                tune::NOTE_HINT,
                &session.head.note,
                TrialWish::Note as fn(SessionId, String) -> TrialWish,
            ),
            (tune::TAGS, tune::TAGS_HINT, &tags, TrialWish::Tags),
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
                pane.actions.push(Action::Trial(wish(id, text)));
            }
        }
    }
}

/// The card of a session that is about to go and lies in no file.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let session = state.tuner.session(state.tuner.question?)?;
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
            back.does(Action::Trial(TrialWish::Decline)),
            forget.does(Action::Trial(TrialWish::Agree)),
        ],
        ..Card::default()
    })
}

/// One of a row of choices; true if it was pressed.
pub(crate) fn choice_ui(
    ui: &mut Ui,
    row: &mut Rect,
    pane: &Pane<'_>,
    (text, tip): (&str, &str),
    chosen: bool,
) -> bool {
    let width = choice_width(ui, text);
    let place = take_left(row, width.min(row.width()));
    row.min.x -= theme::STEP;
    let button = Button::new(text, tip).choice(chosen);
    let response = button.put(ui, pane.look, place, Id::unique(("trial choice", text)));
    response.clicked()
}

/// The room of one of a row of choices.
pub(crate) fn choice_width(ui: &Ui, text: &str) -> f32 {
    controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP
}
