//! The running series: progress, state of the hand, and live force. Changes nothing.

use crate::app::action::Action;
use crate::app::trials::SeriesRun;
use crate::hand::{Dof, Quantity};
use crate::history::Series;
use crate::ui::kit::{self, Button, Label, Pane, Weight, format};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView};
use crate::ui::plots::times::Times;
use crate::ui::text::{tune, words};
use crate::ui::trials::compare_curves::LEAST_S;
use egui::{Color32, Ui};

/// Plot of one trial.
#[derive(Debug, Default)]
pub(crate) struct LiveChart {
    trial: usize,
    view: ChartView,
}

/// Draws the progress of the series, with its end button; nothing without a series.
pub(crate) fn progress_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let Some(run) = pane.hand().running.series() else {
        return;
    };
    let (number, total) = (run.view.number, run.view.total);
    let stage = look.tr(tune::stage(run.view.stage));
    let trial = look.fill(tune::TRIAL, &[&number, &total, &stage]);
    let name = look.tr(tune::PROGRESS);
    ui.horizontal(|ui| {
        let button = Button::text(look, tune::STOP_SERIES).weight(Weight::Danger);
        let response = button.large().ui(ui, look);
        if kit::pressed(ui, &response) {
            pane.actions.push(Action::Stop);
        }
        ui.vertical(|ui| {
            let label = Label::new(&trial, palette.text).large();
            label.named(name).ui(ui);
            let search = pane.state.trials.running_search();
            let progress = search.and_then(|search| search.progress.as_ref());
            let left = progress.map_or_else(|| run.left(pane.state.now), |search| search.left);
            let left = format::duration(left);
            let left = look.fill(tune::LEFT, &[&left]);
            let setting = match run.view.setting {
                Some(_) if run.view.is_probing => look.tr(tune::PROBE).to_owned(),
                Some(own) => look.fill(tune::SETTING, &[&own.speed.get(), &own.force.get()]),
                None => String::new(),
            };
            ui.horizontal(|ui| {
                for text in [setting.as_str(), &left, look.tr(tune::ANY_KEY)] {
                    Label::new(text, palette.muted).small().ui(ui);
                }
            });
        });
    });
    let share = kit::share(number.saturating_sub(1), total);
    kit::progress_ui(ui, look, name, share);
}

/// Draws the live force.
pub(crate) fn force_ui(ui: &mut Ui, pane: &Pane<'_>, chart: &mut LiveChart) {
    let look = pane.look;
    let Some(run) = pane.hand().running.series() else {
        return;
    };
    if chart.trial != run.view.number {
        chart.view.time.follow();
        chart.trial = run.view.number;
    }
    let view = &mut chart.view;
    ui.horizontal(|ui| levels_ui(ui, pane, run));
    let history = &pane.hand().measured.history;
    let (from_s, to_s) = (run.since.secs(), pane.state.now.secs());
    let joints = run.plan.joints().filter(|_| run.view.setting.is_some());
    let lines: Vec<(Dof, Series)> = joints
        .map(|dof| (dof, Series::Joint(Quantity::Force, dof)))
        .collect();
    let all = lines
        .iter()
        .filter_map(|(_, series)| history.summary(*series, from_s, to_s));
    let highest = all.map(|all| f64::from(all.max)).fold(0.0, f64::max);
    let curves = lines
        .iter()
        .map(|(dof, series)| ChartCurve::measured(history, *series, look.palette.dof[*dof]));
    let force = Chart {
        curves: curves.collect(),
        levels: levels(pane, run, highest),
        least: (0.0, 100.0),
        times: Times::From(run.zero.secs(), "0 s"),
        empty: tune::LIVE_EMPTY,
        ..Chart::new(look, tune::LIVE_FORCE, ui.available_height())
    };
    let window_s = (to_s - from_s).max(LEAST_S);
    view.time.advance((from_s, to_s), window_s);
    force.ui(ui, view);
}

/// Draws the legend of curves and levels.
fn levels_ui(ui: &mut Ui, pane: &Pane<'_>, run: &SeriesRun) {
    let (look, palette) = (pane.look, pane.look.palette);
    for dof in run.plan.joints() {
        let joint = Label::new(look.tr(words::dof(dof)), palette.dof[dof]);
        joint.small().ui(ui);
    }
    if let Some(setting) = run.view.setting {
        let threshold = look.fill(tune::THRESHOLD, &[&setting.force.get()]);
        Label::new(&threshold, palette.muted).small().ui(ui);
    }
    let ceiling = look.fill(tune::ENDS_AT, &[&run.plan.limits.ceiling_g]);
    Label::new(&ceiling, palette.bad).small().ui(ui);
}

/// Levels of the threshold, and of the ceiling if it is near enough not to flatten the curve.
fn levels(pane: &Pane<'_>, run: &SeriesRun, highest: f64) -> Vec<(f64, Color32)> {
    let palette = pane.look.palette;
    let threshold = run.view.setting;
    let threshold = threshold.map(|setting| f64::from(setting.force.get()));
    let ceiling = f64::from(run.plan.limits.ceiling_g);
    let near = threshold.unwrap_or(0.0).max(highest) * 2.0 >= ceiling;
    let ceiling = near.then_some((ceiling, palette.bad));
    let threshold = threshold.map(|level| (level, palette.muted));
    threshold.into_iter().chain(ceiling).collect()
}
