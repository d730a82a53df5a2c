//! The view that compares trials: sessions, curves over each other, what was measured, the map of overshoot and the
//! best. Holds what is chosen, no trial.

use crate::app::action::Action;
use crate::app::trial::Criterion;
use crate::app::trial::best::best;
use crate::app::tuner::{Origin, Session, SessionId, Shown, TrialWish};
use crate::hand::Dof;
use crate::ui::compare_best;
use crate::ui::compare_table::{self, Sorting};
use crate::ui::controls::{self, Button, Label, take_left, take_right, take_top};
use crate::ui::look::Pane;
use crate::ui::text::{Text, tune};
use crate::ui::text_field::TextField;
use crate::ui::theme;
use crate::ui::trial_plot::{TrialLine, TrialPlot};
use egui::{Color32, Id, Rect, Ui};

/// Characters of a note.
const NOTE_CHARS: usize = 300;

/// Where the time of the curves begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Align {
    #[default]
    Command,
    Contact,
}

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct CompareView {
    chosen: Option<SessionId>,
    newest: Option<SessionId>,
    shown: Shown,
    align: Align,
    sorting: Sorting,
    /// The trial that stands out.
    strong: Option<usize>,
    best: compare_best::BestView,
    typed: Option<(Id, String)>,
}

impl CompareView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let state = pane.state;
        let sessions = &state.tuner.sessions;
        // What was begun or opened last is shown at once.
        let newest = sessions.last().map(|session| session.id);
        if newest != self.newest {
            (self.newest, self.chosen) = (newest, newest);
        }
        let mut body = controls::card(ui, look, rect);
        let chosen = self.chosen.and_then(|id| state.tuner.session(id));
        let chosen = chosen.or(sessions.last());
        self.head_ui(ui, take_top(&mut body, theme::CONTROL), pane, chosen);
        let Some(session) = chosen else {
            Label::new(look.say(tune::COMPARE_EMPTY), look.palette.muted)
                .center()
                .put(ui, body);
            return;
        };
        self.words_ui(ui, take_top(&mut body, theme::CONTROL), pane, session);
        let curves = body.height() * theme::CURVES_SHARE;
        let mut upper = take_top(&mut body, curves);
        let width = (upper.width() * theme::MAP_SHARE).clamp(theme::MAP_LEAST, theme::MAP_MOST);
        let side = take_right(&mut upper, width);
        self.curves_ui(ui, upper, pane, session);
        self.best.ui(ui, side, pane, session);
        compare_table::table_ui(
            ui,
            body,
            pane,
            session,
            (&mut self.sorting, &mut self.strong),
        );
    }

    fn head_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, now: Option<&Session>) {
        let look = pane.look;
        let runs = pane.state.tuner.run.as_ref().map(|run| run.session);
        let cannot = match now {
            None => Some(look.say(tune::COMPARE_EMPTY)),
            Some(own) if Some(own.id) == runs => Some(look.say(tune::SAVE_RUNS)),
            Some(own) if matches!(own.origin, Origin::Folder(_)) => Some(look.say(tune::SAVE_READ)),
            Some(_) => None,
        };
        let id = now.map(|own| own.id);
        let save = id.map(|id| TrialWish::Save(id, Some(self.best.criterion())));
        for (text, tip, disabled, wish) in [
            (tune::SAVE, tune::SAVE_TIP, cannot, save),
            (tune::OPEN, tune::OPEN_TIP, None, Some(TrialWish::Open)),
        ] {
            let words = look.say(text);
            let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
            let place = take_right(&mut row, width);
            let button = Button::new(words, look.say(tip)).disabled(disabled);
            let clicked = button.put(ui, look, place, Id::unique(("compare", text.en)));
            if clicked.clicked()
                && let Some(wish) = wish
            {
                pane.actions.push(Action::Trial(wish));
            }
        }
        // The newest first, as far as there is room.
        for session in pane.state.tuner.sessions.iter().rev() {
            let text = format!("{} {}", look.say(tune::SESSION), session.id.0);
            let width = controls::text_width(ui, &text, theme::body()) + 2.0 * theme::PAD;
            if row.width() < width {
                break;
            }
            let place = take_left(&mut row, width);
            let button = Button::new(&text, look.say(tune::SESSION_TIP));
            let button = button.choice(id == Some(session.id));
            let clicked = button.put(ui, look, place, Id::unique(("session", session.id)));
            if clicked.clicked() {
                (self.chosen, self.strong) = (Some(session.id), None);
            }
        }
    }

    /// Whose hand it was, note and tags.
    fn words_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, session: &Session) {
        let look = pane.look;
        // What was tried on the built-in hand belongs to no day.
        let about = if session.head.simulated {
            session.head.hand.clone()
        } else {
            let day = crate::app::quirk_sheet::day(session.head.begun);
            format!("{day}  {}", session.head.hand)
        };
        let width = row.width() * theme::MAP_SHARE;
        let place = take_left(&mut row, width);
        Label::new(&about, look.palette.muted)
            .small()
            .put(ui, place);
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

    fn curves_ui(&mut self, ui: &mut Ui, mut rect: Rect, pane: &Pane<'_>, session: &Session) {
        let look = pane.look;
        let mut row = take_top(&mut rect, theme::CONTROL);
        for shown in Shown::ALL {
            let text = look.say(title(shown));
            let tip = look.say(tune::SHOWN_TIP);
            if choice_ui(ui, &mut row, pane, (text, tip), self.shown == shown) {
                self.shown = shown;
            }
        }
        let mut row = take_top(&mut rect, theme::CONTROL);
        for (align, text) in [
            (Align::Command, tune::ON_COMMAND),
            (Align::Contact, tune::ON_CONTACT),
        ] {
            let tip = look.say(tune::ALIGN_TIP);
            if choice_ui(
                ui,
                &mut row,
                pane,
                (look.say(text), tip),
                self.align == align,
            ) {
                self.align = align;
            }
        }
        let mut lines = Vec::new();
        for tried in &session.trials {
            let strong = self.strong == Some(tried.number);
            for joint in &tried.lines.0 {
                let zero_s = match self.align {
                    Align::Command => Some(0.0),
                    Align::Contact => joint.contact_s,
                };
                let Some(zero_s) = zero_s else { continue };
                let points = joint.points(self.shown);
                if points.is_empty() {
                    continue;
                }
                let color = color(pane, session, tried.number, joint.dof);
                let share = match self.strong {
                    Some(_) if !strong => theme::CURVE_BEHIND,
                    _ => 1.0,
                };
                let line = TrialLine {
                    points,
                    zero_s,
                    color: color.gamma_multiply(share),
                    width: if strong { theme::STRONG } else { theme::LINE },
                };
                lines.push((strong, line));
            }
        }
        lines.sort_by_key(|(strong, _)| *strong);
        let mut levels: Vec<f64> = Vec::new();
        if self.shown == Shown::Force {
            let forces = session.trials.iter().map(|own| own.setting.force.get());
            levels = forces.map(f64::from).collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup();
        }
        let plot = TrialPlot {
            look,
            name: look.say(title(self.shown)),
            empty: look.say(tune::CURVES_EMPTY),
            lines: lines.into_iter().map(|(_, line)| line).collect(),
            levels,
            least: (0.0, 1.0),
        };
        plot.ui(ui, rect);
    }
}

/// The settings that one joint was tried with have a colour each; of several joints, each joint has its own.
pub(crate) fn color(pane: &Pane<'_>, session: &Session, number: usize, dof: Dof) -> Color32 {
    let palette = pane.look.palette;
    let several = session
        .trials
        .iter()
        .any(|tried| tried.metrics.joints.len() > 1);
    if several {
        return palette.dof[dof];
    }
    let mut settings: Vec<_> = session.trials.iter().map(|own| own.setting).collect();
    settings.sort_unstable();
    settings.dedup();
    let tried = session.trials.iter().find(|own| own.number == number);
    let at = tried.and_then(|own| settings.iter().position(|each| *each == own.setting));
    let colors = Dof::ALL.map(|dof| palette.dof[dof]);
    let at = at.unwrap_or(0) % colors.len();
    colors.get(at).copied().unwrap_or(palette.text)
}

const fn title(shown: Shown) -> Text {
    match shown {
        Shown::Force => tune::SHOW_FORCE,
        Shown::Angle => tune::SHOW_ANGLE,
        Shown::Current => tune::SHOW_CURRENT,
        Shown::Touch => tune::SHOW_TOUCH,
    }
}

/// One of a row of choices; true if it was pressed.
pub(crate) fn choice_ui(
    ui: &mut Ui,
    row: &mut Rect,
    pane: &Pane<'_>,
    (text, tip): (&str, &str),
    chosen: bool,
) -> bool {
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
    let place = take_left(row, width.min(row.width()));
    row.min.x -= theme::STEP;
    let button = Button::new(text, tip).choice(chosen);
    let response = button.put(ui, pane.look, place, Id::unique(("trial choice", text)));
    response.clicked()
}

/// The best setting of a session.
pub(crate) fn best_of(
    session: &Session,
    criterion: Criterion,
) -> Option<crate::app::trial::Setting> {
    best(&session.scores(), criterion).map(|score| score.setting)
}
