//! The view of grasp trials: the plan at the left, results at the right. Holds text in progress only.

use crate::app::action::Action;
use crate::app::trials::{SeriesKind, TrialAction};
use crate::hand::impact::NOTABLE_G;
use crate::trials::estimate;
use crate::ui::kit::{
    self, Button, Pane, Pick, StartButton, StartWish, Typing, ViewRequest, Weight, format,
    start_refused,
};
use crate::ui::text::tune;
use crate::ui::text::tune::search;
use crate::ui::theme;
use crate::ui::trials::compare::ResultsView;
use crate::ui::trials::compare_choice::ResultsPlace;
use crate::ui::trials::search_form;
use crate::ui::trials::tune_form::TuneForm;
use crate::ui::view::View;
use egui::{Frame, Panel, Ui};

/// View state.
#[derive(Debug, Default)]
pub(crate) struct TuneView {
    kind: SeriesKind,
    form: TuneForm,
    start: StartButton,
    results: ResultsView,
}

impl TuneView {
    /// Draws plan and results.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let width = (ui.available_width() * 0.34).clamp(348.0, 424.0);
        kit::bare(Panel::left("plan"), width, theme::GAP_RIGHT).show(ui, |ui| {
            kit::full_card_ui(ui, look, |ui| {
                kit::head_ui(ui, look, look.tr(tune::PLAN), |ui| {
                    let fold = Button::text(look, tune::HIDE_PLAN).icon(theme::TO_LEFT);
                    let fold = fold.weight(Weight::Quiet);
                    fold.navigate(ui, pane, ViewRequest::View(View::Compare));
                });
                ui.horizontal(|ui| {
                    let all = [
                        (SeriesKind::Search, search::FIND),
                        (SeriesKind::Grid, search::GRID),
                    ];
                    let before = self.kind;
                    Pick::new(look, search::WAY).ui(ui, &mut self.kind, all);
                    if self.kind != before {
                        *pane.typing = Typing::default();
                    }
                });
                let start = Panel::bottom("start").resizable(false);
                let start = start.show_separator_line(false).frame(Frame::NONE);
                start.show(ui, |ui| {
                    ui.add_space(theme::GAP);
                    if self.kind == SeriesKind::Grid {
                        meaning_ui(ui, pane);
                    }
                    self.start.ui(ui, pane, start_wish(pane, self.kind));
                });
                match self.kind {
                    SeriesKind::Search => search_form::ui(ui, pane),
                    SeriesKind::Grid => self.form.ui(ui, pane),
                }
            });
        });
        self.results.ui(ui, pane, ResultsPlace::BesidePlan);
    }

    /// Draws the results over all of `ui`, with the plan collapsed.
    pub(crate) fn results_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.results.ui(ui, pane, ResultsPlace::Alone);
    }
}

/// Labels and actions of the start button.
fn start_wish(pane: &Pane<'_>, kind: SeriesKind) -> StartWish {
    let wanted = pane.state.trials.planned(kind);
    // Refused text is not part of the plan that would run.
    let is_sound = wanted.is_sound() && pane.typing.refused.is_none();
    let unsound = (!is_sound).then_some(tune::PLAN_WRONG);
    let refusal = pane.hand().series_refusal(Some(&wanted.trials()));
    let [start, arm] =
        [TrialAction::Start(kind), TrialAction::ArmAndStart(kind)].map(Action::Trial);
    StartWish {
        refused: start_refused(pane, unsound, refusal),
        start: (tune::START_BUTTON, start),
        arm_and_start: (tune::ARM_AND_START, arm),
    }
}

/// Draws the size and duration of the series, and the expected overshoot.
fn meaning_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let plan = &pane.state.trials.plan;
    if plan.check().is_err() {
        return;
    }
    let (count, time) = estimate::series(plan);
    let mut words = look.fill(tune::WILL, &[&count, &format::duration(time)]);
    if count > plan.grid.settings().len() {
        words = format!("{words} {}", look.tr(tune::WILL_PROBE));
    }
    kit::small_text_ui(ui, &words, palette.text);
    if let Some((setting, expected)) = plan.expected(&pane.hand().overshoot.map) {
        let peak = expected.over_g;
        let (peak_g, force) = (format!("{peak:.0}"), setting.force.get());
        let words = look.fill(tune::EXPECT, &[&peak_g, &setting.speed.get(), &force]);
        let color = if peak >= NOTABLE_G {
            palette.warn
        } else {
            palette.muted
        };
        let label = kit::small_text_ui(ui, &words, color);
        let measured = tune::measured_on(look, &expected.on);
        label.on_hover_text(format!("{}\n{measured}", look.tip(tune::EXPECT)));
    }
}
