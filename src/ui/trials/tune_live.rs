//! The series that runs: how far it is, what the hand does, the force as it comes, temperatures. Changes nothing.

use crate::app::action::Action;
use crate::app::hand::Freshness;
use crate::app::trials::SeriesRun;
use crate::hand::Dof;
use crate::trials::recording::{TrialRecording, seconds};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_top};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::plots::chart::{Chart, ChartView, Curve, Points};
use crate::ui::text::{trials, tune, words};
use crate::ui::theme;
use crate::ui::trials::plot::trial_chart_ui;
use egui::{Color32, CornerRadius, Id, Rect, Role, Sense, Stroke, Ui, UiBuilder, WidgetInfo};

/// Readings of the newest part that are drawn: more than a plot has pixels, and some twenty seconds.
const READINGS_DRAWN: usize = 2400;

/// Draws it.
pub(crate) fn live_ui(ui: &mut Ui, mut body: Rect, pane: &mut Pane<'_>, chart: &mut ChartView) {
    let Some(run) = &pane.state.hand().series else {
        return;
    };
    let look = pane.look;
    let text = look.say(tune::STOP_SERIES);
    let place = take_top(&mut body, theme::CONTROL_LARGE);
    let button = Button::new(text, look.say(tune::STOP_SERIES_TIP)).weight(Weight::Stop);
    let response = button.ground(ui, look, place, Id::unique("end trials"));
    let (center, color) = (egui::Align2::CENTER_CENTER, look.palette.on_strong);
    controls::paint_text(ui, place, center, text, theme::title(), color);
    if controls::pressed(ui, &response) {
        pane.actions.push(Action::Stop);
    }
    head_ui(ui, &mut body, pane, run);
    heat_ui(ui, &mut body, pane);
    if body.height() >= theme::TRIAL_PLOT_LEAST {
        let place = UiBuilder::new().max_rect(body);
        ui.scope_builder(place, |ui| force_ui(ui, pane, run, chart));
    }
}

fn head_ui(ui: &mut Ui, body: &mut Rect, pane: &Pane<'_>, run: &SeriesRun) {
    let look = pane.look;
    let (number, total) = (run.view.number, run.view.total);
    let stage = look.say(trials::stage(run.view.stage));
    let trial = format!(
        "{} {number} {} {total}: {stage}",
        look.say(tune::TRIAL),
        look.say(tune::OF)
    );
    let place = take_top(body, theme::TITLE_LINE);
    Label::new(&trial, look.palette.text)
        .font(theme::title())
        .named(look.say(tune::PROGRESS))
        .put(ui, place);
    bar_ui(ui, take_top(body, theme::TRIAL_BAR), pane, (number, total));
    let mut line = match run.view.setting {
        Some(_) if run.view.is_probing => look.say(tune::PROBE).to_owned(),
        Some(setting) => format!(
            "{} {}, {} {} g",
            look.say(tune::SPEED),
            setting.speed.get(),
            look.say(tune::THRESHOLD),
            setting.force.get()
        ),
        None => String::new(),
    };
    let left = format::duration(run.left(pane.state.now));
    if !line.is_empty() {
        line.push_str("; ");
    }
    line.push_str(&format!("{} {left}", look.say(tune::LEFT)));
    let place = take_top(body, theme::LIST_LINE);
    Label::new(&line, look.palette.muted).small().put(ui, place);
    let keys = look.say(tune::ANY_KEY);
    let place = take_top(body, theme::LIST_LINE);
    Label::new(keys, look.palette.muted).small().put(ui, place);
}

/// The share of the trials that began.
fn bar_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, (number, total): (usize, usize)) {
    let look = pane.look;
    let response = ui.interact(rect, Id::unique("trial bar"), Sense::hover());
    let name = look.say(tune::PROGRESS);
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, name));
    let round = CornerRadius::same(theme::ROUND_TINY);
    ui.painter().rect_filled(rect, round, look.palette.sunken);
    let count = |number: usize| f32::from(u16::try_from(number).unwrap_or(u16::MAX));
    let share = count(number.saturating_sub(1)) / count(total.max(1));
    let done = rect.with_max_x(rect.left() + rect.width() * share);
    ui.painter().rect_filled(done, round, look.palette.accent);
}

fn heat_ui(ui: &mut Ui, body: &mut Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let mut row = take_top(body, theme::LIST_LINE);
    let name = look.say(tune::TEMPS);
    let width = controls::text_width(ui, name, theme::small()) + 1.0;
    let place = take_left(&mut row, width);
    Label::new(name, look.palette.muted).small().put(ui, place);
    let read = pane.state.hand().sample.temperature;
    let freshness = pane.freshness(read.map(|read| read.asked));
    let each = row.width() / 6.0;
    for dof in Dof::ALL {
        let celsius = read.and_then(|read| read.value[dof].documented());
        let text = celsius.map_or_else(|| "-".to_owned(), |celsius| celsius.to_string());
        let (cell, rest) = row.split_left_right_at_x(row.left() + each);
        row = rest;
        // Temperatures are read some times a second only.
        let color = match freshness {
            Freshness::Unknown => look.palette.faint,
            Freshness::Live | Freshness::Stale => look.palette.dof[dof],
        };
        let label = format!("{} {name}", look.say(words::dof(dof)));
        Label::new(&text, color)
            .font(theme::number_small())
            .named(&label)
            .put(ui, cell);
    }
}

fn force_ui(ui: &mut Ui, pane: &Pane<'_>, run: &SeriesRun, chart: &mut ChartView) {
    let look = pane.look;
    levels_ui(ui, pane, run);
    let lines: Vec<(Dof, Vec<[f64; 2]>)> = match run.view.setting {
        Some(_) => run
            .plan
            .joints()
            .map(|dof| (dof, force(&run.recording, dof)))
            .collect(),
        None => Vec::new(),
    };
    let all = lines.iter().flat_map(|(_, points)| points);
    let highest = all.map(|[_, grams]| *grams).fold(0.0, f64::max);
    let curves = lines.iter().map(|(dof, points)| {
        let stroke = Stroke::new(theme::LINE, look.palette.dof[*dof]);
        Curve::new(Points::Own(points), stroke)
    });
    let force = Chart {
        curves: curves.collect(),
        levels: levels(pane, run, highest),
        least: (0.0, 100.0),
        empty: tune::LIVE_EMPTY,
        ..Chart::new(look, tune::LIVE_FORCE, ui.available_height())
    };
    trial_chart_ui(ui, force, chart);
}

/// What the levels are.
fn levels_ui(ui: &mut Ui, pane: &Pane<'_>, run: &SeriesRun) {
    let look = pane.look;
    ui.horizontal(|ui| {
        if let Some(setting) = run.view.setting {
            let threshold = format!("{} {} g", look.say(tune::THRESHOLD), setting.force.get());
            Label::new(&threshold, look.palette.muted).small().ui(ui);
        }
        let ceiling = run.plan.limits.ceiling_g;
        let ceiling = format!("{} {ceiling} g", look.say(tune::ENDS_AT));
        Label::new(&ceiling, look.palette.bad).small().ui(ui);
    });
}

/// The threshold; the ceiling where it is near enough not to flatten the curve.
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

/// The newest forces of a joint, as they came.
fn force(recording: &TrialRecording, dof: Dof) -> Vec<[f64; 2]> {
    let zero = recording.zero();
    let rows = recording.rows();
    let read = rows
        .iter()
        .rev()
        .filter_map(|row| Some((row.at, row.force?[dof])));
    let point = |(at, grams)| [seconds(zero, at), f64::from(grams)];
    let mut points: Vec<[f64; 2]> = read.take(READINGS_DRAWN).map(point).collect();
    points.reverse();
    points
}
