//! Results of trials: progress or end of the series, overlaid curves, measurements, the map of overshoot and the best setting.
//! Holds the selection only, no trial.

use crate::app::action::Action;
use crate::app::state::State;
use crate::app::trials::{Comparison, SessionId, SessionOrigin, TrialAction, TrialSession};
use crate::ui::hand::panel::StillHand;
use crate::ui::kit::path_field::path_ui;
use crate::ui::kit::{
    self, Button, ButtonRole, Card, CardButton, Label, Look, Pane, Pick, TextField, ViewRequest,
    Weight,
};
use crate::ui::text::{notices, tune};
use crate::ui::theme;
use crate::ui::touch::heat;
use crate::ui::trials::compare_best::{self, BestView};
use crate::ui::trials::compare_choice::{ResultsPlace, ShownSessions, TrialKey};
use crate::ui::trials::compare_curves::CurvesView;
use crate::ui::trials::compare_list;
use crate::ui::trials::compare_list::SessionSheet;
use crate::ui::trials::compare_table::{self, TableView};
use crate::ui::trials::overshoot::{OvershootView, no_trials_ui};
use crate::ui::trials::tune_live::{self, LiveChart};
use crate::ui::view::View;
use egui::{Panel, ScrollArea, Ui, vec2};

const NOTE_CHARS: usize = 300;
/// Minimum width at which the best setting is beside curves and table, and at which it is beside the curves.
const WIDE: f32 = 1500.0;
const BESIDE: f32 = 640.0;
/// Minimum height of curves, their choices and the map of overshoot; the table yields.
const CURVES_LEAST: f32 = 272.0;
/// Maximum width of a session's path.
const PLACE: f32 = 280.0;

/// View state of the results.
#[derive(Debug, Default)]
pub(crate) struct ResultsView {
    chosen: ShownSessions,
    comparison: Option<Comparison>,
    curves: CurvesView,
    live: LiveChart,
    table: TableView,
    /// The highlighted trial.
    strong: Option<TrialKey>,
    best: BestView,
    /// Show the hand's measured overshoot in place of trials.
    is_of_hand: bool,
    map: OvershootView,
    hand: StillHand,
}

impl ResultsView {
    /// Draws the results.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, place: ResultsPlace) {
        let look = pane.look;
        let trials = &pane.state.trials;
        self.chosen.follow(&trials.sessions);
        kit::full_card_ui(ui, look, |ui| {
            let focus = self.chosen.focus.and_then(|id| trials.session(id));
            ui.horizontal(|ui| {
                if place == ResultsPlace::Alone {
                    let unfold = Button::text(look, tune::SHOW_PLAN).icon(theme::TO_RIGHT);
                    let unfold = unfold.weight(Weight::Quiet);
                    unfold.navigate(ui, pane, ViewRequest::View(View::Tune));
                }
                kit::head_ui(ui, look, look.tr(tune::RESULTS), |ui| {
                    if let Some(session) = focus.filter(|_| !self.is_of_hand) {
                        self.files_ui(ui, pane, session);
                    }
                    kit::left_ui(ui, |ui| {
                        let all = [(false, tune::MAP_TRIALS), (true, tune::MAP_SHOW)];
                        Pick::new(look, tune::MAP_WHICH).ui(ui, &mut self.is_of_hand, all);
                    });
                });
            });
            if self.is_of_hand {
                return self.map.ui(ui, pane);
            }
            if let Some(refused) = &trials.refused {
                kit::small_text_ui(ui, &notices::notice(look, refused), look.palette.warn);
            }
            if trials.asks_path
                && let Some(path) = path_ui(ui, look, "session")
            {
                let open = TrialAction::Open(Some(path));
                pane.actions.push(Action::Trial(open));
            }
            let Some(session) = focus else {
                return self.empty_ui(ui, pane);
            };
            tune_live::progress_ui(ui, pane);
            if trials.sessions.len() > 1 {
                compare_list::list_ui(ui, SessionSheet { look, trials }, &mut self.chosen);
            }
            let focus = self.chosen.focus.and_then(|id| trials.session(id));
            let session = focus.unwrap_or(session);
            if trials.running != Some(session.id) {
                end_ui(ui, pane, session);
            }
            if trials.running != Some(session.id) && ui.available_width() >= BESIDE {
                ui.horizontal(|ui| words_ui(ui, pane, session));
            }
            self.session_ui(ui, pane, session, place);
        });
    }

    /// Draws the next step while nothing was tried, above the hand that will try it.
    fn empty_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        no_trials_ui(ui, look, tune::IDLE_TITLE, tune::IDLE_BODY);
        let open = Button::text(look, tune::OPEN_EARLIER);
        open.on_click(ui, pane, Action::Trial(TrialAction::Open(None)));
        self.hand.rest_ui(ui, pane, &heat::tips(pane), None);
    }

    /// Draws the curves above the table, with the best setting beside them if it fits.
    fn session_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        focus: &TrialSession,
        place: ResultsPlace,
    ) {
        let mut comparison = self.comparison(pane, focus.id);
        comparison.judge(&pane.state.trials, self.best.criterion());
        let room = ui.available_size();
        let run = pane.hand().running.series();
        let runs = run.is_some_and(|run| run.session == focus.id);
        let is_empty = comparison.rows.is_empty();
        if runs && is_empty {
            tune_live::force_ui(ui, pane, &mut self.live);
            self.comparison = Some(comparison);
            return;
        }
        // No defaults can be saved while the hand is armed: the best setting appears at the end.
        if !runs && room.x >= WIDE {
            self.best_ui(ui, pane, &comparison, (focus, place));
        }
        let height = compare_table::height(comparison.rows.len());
        let most = (room.y - CURVES_LEAST).max(room.y * 0.4);
        let table = Panel::bottom("trial table");
        let table = kit::bare(table, height.min(most), theme::GAP_TOP);
        table.show(ui, |ui| {
            let replay = self.table.ui(ui, pane, &comparison, &mut self.strong);
            pane.actions.extend(replay.map(Action::Recording));
        });
        if !runs && (BESIDE..WIDE).contains(&room.x) {
            self.best_ui(ui, pane, &comparison, (focus, place));
        } else if !runs && room.x < BESIDE {
            compare_best::best_ui(ui, pane, &comparison, place);
        }
        if runs && ui.available_width() >= BESIDE / 2.0 {
            let width = ui.available_width() * 0.4;
            let live = kit::bare(Panel::left("live"), width, theme::GAP_RIGHT);
            live.show(ui, |ui| {
                tune_live::force_ui(ui, pane, &mut self.live);
            });
        }
        self.curves.ui(ui, pane, &comparison, &mut self.strong);
        self.comparison = Some(comparison);
    }

    fn best_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        comparison: &Comparison,
        (focus, place): (&TrialSession, ResultsPlace),
    ) {
        let width = (ui.available_width() * 0.36).clamp(288.0, 440.0);
        kit::bare(Panel::right("best"), width, theme::GAP_LEFT).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                self.best.ui(ui, pane, comparison, (focus, place));
            });
        });
    }

    /// Comparison of the shown sessions, recomputed only when they change.
    fn comparison(&mut self, pane: &Pane<'_>, focus: SessionId) -> Comparison {
        let trials = &pane.state.trials;
        let shown = &self.chosen.shown;
        let former = self.comparison.take();
        if let Some(former) = former.filter(|own| own.is_current(trials, shown, focus)) {
            return former;
        }
        self.curves.forget();
        self.table.forget();
        Comparison::of(trials, shown, focus)
    }

    /// Draws the file actions of the current session, from right to left.
    fn files_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, session: &TrialSession) {
        let look = pane.look;
        let runs = pane.state.trials.running == Some(session.id);
        let runs = runs.then(|| look.tr(tune::SAVE_RUNS));
        let forget = Button::text(look, tune::FORGET).disabled(runs);
        let forget = forget.weight(Weight::Quiet);
        forget.on_click(ui, pane, Action::Trial(TrialAction::Forget(session.id)));
        self.place_ui(ui, pane, session, runs);
        let open = Button::text(look, tune::OPEN).weight(Weight::Quiet);
        open.on_click(ui, pane, Action::Trial(TrialAction::Open(None)));
    }

    /// Draws the path of the session's files; a click saves them in a folder that the user chooses.
    fn place_ui(
        &self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        session: &TrialSession,
        runs: Option<&str>,
    ) {
        let look = pane.look;
        let (words, read) = match &session.origin {
            SessionOrigin::Unsaved => (look.tr(tune::SAVE).to_owned(), None),
            SessionOrigin::Saved(place) => (look.fill(tune::SAVED_IN, &[&place.display()]), None),
            SessionOrigin::Folder(place) => {
                let words = look.fill(tune::READ_FROM, &[&place.display()]);
                (words, Some(look.tr(tune::SAVE_READ)))
            }
        };
        let tip = format!("{words}\n{}", look.tip(tune::SAVE));
        let is_saved = session.origin.is_in_files();
        let button = Button::new(&words, if is_saved { &tip } else { look.tip(tune::SAVE) });
        let button = button.named(look.tr(tune::SAVE)).disabled(runs.or(read));
        let width = kit::text_width(ui, &words, theme::body()) + 2.0 * theme::PAD;
        let most = (ui.available_width() * 0.5).min(PLACE);
        let (id, place) = ui.allocate_space(vec2(width.min(most), theme::CONTROL));
        let response = button.put(ui, look, place, id);
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_value(words));
        if response.clicked() {
            let save = TrialAction::Save(session.id, Some(self.best.criterion()));
            pane.actions.push(Action::Trial(save));
        }
    }
}

/// Draws the outcome of a series.
fn end_ui(ui: &mut Ui, pane: &Pane<'_>, session: &TrialSession) {
    let (look, palette) = (pane.look, pane.look.palette);
    let (ended, color) = match &session.head.aborted {
        None => (look.tr(tune::ALL_DONE).to_owned(), palette.ok),
        Some(why) => (tune::ended(look, why), palette.warn),
    };
    let is_last = pane.state.trials.last == Some(session.id);
    let words = if is_last {
        look.fill(tune::LAST, &[&ended])
    } else {
        ended
    };
    kit::small_text_ui(ui, &words, color);
}

/// Draws note and tags of the current session, side by side.
fn words_ui(ui: &mut Ui, pane: &mut Pane<'_>, session: &TrialSession) {
    let look = pane.look;
    let (id, head) = (session.id, &session.head);
    let tags = head.tags.join(", ");
    let note = TrialAction::Note as fn(SessionId, String) -> TrialAction;
    let share = ui.available_width() / 2.0;
    for (name, value, action) in [
        (tune::NOTE, &head.note, note),
        (tune::TAGS, &tags, TrialAction::Tags),
    ] {
        let field = TextField::new(look.tr(name), NOTE_CHARS).hint(look.tip(name));
        let size = vec2(share - theme::GAP, theme::CONTROL);
        ui.push_id((id, name.en), |ui| {
            kit::cell_ui(ui, size, |ui| {
                Label::note(look, name).ui(ui);
                if let Some(text) = field.ui(ui, pane, value) {
                    pane.actions.push(Action::Trial(action(id, text)));
                }
            });
        });
    }
}

/// Card that confirms removing a session without a file.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let session = state.trials.session(state.trials.to_confirm?)?;
    let loses = look.fill(tune::FORGET_LOSES, &[&session.trials.len()]);
    let keep = Action::Trial(TrialAction::CancelForget);
    let back = CardButton::new(tune::FORGET_NOT, ButtonRole::Safe, keep);
    let forget = Action::Trial(TrialAction::ConfirmForget);
    let forget = CardButton::new(tune::FORGET_SURE, ButtonRole::Danger, forget);
    let card = Card::new(look, tune::FORGET_TITLE).words(compare_list::name(look, session.id));
    Some(card.warning(loses).choice(back).choice(forget))
}
