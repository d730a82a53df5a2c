//! The view of grasp trials: the plan at the left, what it means and the series that runs at the right. Holds text in
//! progress only.

use crate::app::action::Action;
use crate::app::trials::{StartRefusal, TrialAction};
use crate::hand::impact::NOTABLE_G;
use crate::trials::estimate;
use crate::ui::kit::{self, Button, Label, Pane, Weight, format};
use crate::ui::text::{main, tune, words};
use crate::ui::theme;
use crate::ui::trials::PLOT_LEAST;
use crate::ui::trials::tune_form::TuneForm;
use crate::ui::trials::tune_live::{self, LiveChart};
use crate::ui::trials::tune_result::ResultView;
use egui::{Margin, Panel, ScrollArea, Ui};

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct TuneView {
    form: TuneForm,
    live: LiveChart,
    result: ResultView,
}

impl TuneView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let width = (ui.available_width() * 0.44).clamp(326.0, 428.0);
        kit::bare(Panel::left("plan"), width, theme::GAP_RIGHT).show(ui, |ui| {
            kit::card_ui(ui, look, |ui| {
                kit::head_ui(ui, look, look.say(tune::PLAN), |_| ());
                self.form.ui(ui, pane);
            });
        });
        kit::card_ui(ui, look, |ui| {
            ui.set_min_height(ui.available_height());
            kit::head_ui(ui, look, look.say(tune::SERIES), |_| ());
            if pane.state.hand().series.is_some() {
                tune_live::live_ui(ui, pane, &mut self.live)
            } else {
                self.rest_ui(ui, pane)
            }
        });
    }

    /// What a series would mean, over what came out of the last one.
    fn rest_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let trials = &pane.state.trials;
        let last = trials.last.and_then(|id| trials.session(id));
        start_ui(ui, pane);
        let height = ui.available_height();
        let curves = (height - 260.0).max(height * 0.45);
        if let Some(session) = last.filter(|_| curves >= PLOT_LEAST) {
            let panel = kit::bare(Panel::bottom("last series"), curves, Margin::ZERO);
            panel.show(ui, |ui| self.result.curves_ui(ui, pane, session));
        }
        let lines = ScrollArea::vertical().id_salt("series").auto_shrink(false);
        lines.show(ui, |ui| {
            if let Some(session) = last {
                self.result.lines_ui(ui, pane, session);
            }
            meaning_ui(ui, pane);
            if last.is_none() {
                let palette = pane.look.palette;
                Label::said(pane.look, tune::IDLE_TITLE).ui(ui);
                kit::say_ui(ui, pane.look.say(tune::IDLE_BODY), palette.muted);
            }
        });
    }
}

/// Why the series cannot begin, in words.
fn refusal(pane: &Pane<'_>) -> Option<String> {
    let (look, hand, plan) = (pane.look, pane.state.hand(), &pane.state.trials.plan);
    if !hand.connection.status.state.is_live() {
        return Some(look.say(main::REFUSED_OFFLINE).into());
    }
    if plan.check().is_err() {
        return Some(look.say(tune::PLAN_WRONG).into());
    }
    hand.series_refusal(plan).map(|why| match why {
        StartRefusal::NotArmed => look.say(tune::NEED_ARM).into(),
        StartRefusal::Runs => look.say(main::SERIES_RUNS).into(),
        StartRefusal::Locked(dof) => look.fill(tune::NEED_FREE, &[&look.say(words::dof(dof))]),
    })
}

/// The button that begins, over why it cannot.
fn start_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let reason = refusal(pane);
    let button = Button::said(look, tune::START_BUTTON).large();
    let button = button.disabled(reason.as_deref()).weight(Weight::Strong);
    kit::wide_ui(ui, |ui| {
        ui.set_max_height(theme::CONTROL_LARGE);
        button.on_click(ui, pane, Action::Trial(TrialAction::Start));
    });
    kit::say_ui(ui, reason.as_deref().unwrap_or(" "), look.palette.warn);
}

/// What will happen, and how hard it may hit.
fn meaning_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let plan = &pane.state.trials.plan;
    if plan.check().is_err() {
        return;
    }
    let (count, time) = estimate::series(plan);
    let joints: Vec<&str> = plan.joints().map(|dof| look.say(words::dof(dof))).collect();
    let parts: [&dyn std::fmt::Display; 3] = [&look.list(&joints), &count, &format::duration(time)];
    kit::say_ui(ui, &look.fill(tune::WILL, &parts), palette.text);
    if count > plan.grid.settings().len() {
        kit::say_ui(ui, look.say(tune::WILL_PROBE), palette.muted);
    }
    if let Some((setting, peak)) = plan.expected() {
        let (peak_g, force) = (format!("{peak:.0}"), setting.force.get());
        let parts: [&dyn std::fmt::Display; 3] = [&peak_g, &setting.speed.get(), &force];
        let text = look.fill(tune::EXPECT, &parts);
        let is_rough = peak >= NOTABLE_G;
        let color = if is_rough {
            palette.warn
        } else {
            palette.muted
        };
        kit::say_ui(ui, &text, color);
        if is_rough {
            kit::say_ui(ui, look.say(tune::EXPECT_WHY), palette.muted);
        }
    }
    kit::say_ui(ui, look.say(tune::ANY_KEY), palette.muted);
}
