//! What stands over the plots: legend, window, pause. Draws no curve.

use crate::app::action::Action;
use crate::app::settings::PlotWindow;
use crate::hand::Dof;
use crate::ui::controls::{self, Button, Weight, take_left, take_right, take_top};
use crate::ui::look::{Look, Pane};
use crate::ui::plots::PlotView;
use crate::ui::text::{panels, words};
use crate::ui::theme;
use egui::{Align2, Color32, CornerRadius, Id, Rect, Stroke, Ui, pos2, vec2};

/// Height of a row of the legend.
const ROW: f32 = 20.0;
/// Free room beside the title below which the switches are drawn short.
const NARROW: f32 = 380.0;

/// The switches beside the title.
pub(crate) fn head_ui(ui: &mut Ui, mut head: Rect, pane: &mut Pane<'_>, view: &mut PlotView) {
    let narrow = head.width() < NARROW;
    pause_ui(ui, &mut head, pane, view, narrow.then_some(28.0));
    window_ui(ui, head, pane);
}

fn pause_ui(
    ui: &mut Ui,
    head: &mut Rect,
    pane: &mut Pane<'_>,
    view: &mut PlotView,
    icon_width: Option<f32>,
) {
    let look = pane.look;
    let paused = view.held_s.is_some();
    let text = look.say(if paused {
        panels::PAUSED
    } else {
        panels::PAUSE
    });
    let place = take_right(head, icon_width.unwrap_or(72.0));
    let mut button = Button::new(text, look.say(panels::PAUSE_TIP))
        .named(look.say(panels::PAUSE_NAME))
        .weight(if paused {
            Weight::Armed
        } else {
            Weight::Normal
        });
    button.selected = Some(paused);
    let id = Id::unique("pause plots");
    let response = if icon_width.is_some() {
        let response = button.ground(ui, look, place, id);
        bars(ui, place, button.text_color(look));
        response
    } else {
        button.put(ui, look, place, id)
    };
    if response.clicked() {
        view.held_s = (!paused).then(|| pane.state.now.secs());
        pane.actions.push(Action::PausePlots(!paused));
    }
}

/// The two bars of "pause".
fn bars(ui: &Ui, place: Rect, color: Color32) {
    for x in [-3.5, 3.5] {
        let bar = Rect::from_center_size(place.center() + vec2(x, 0.0), vec2(3.0, 11.0));
        ui.painter().rect_filled(bar, CornerRadius::same(1), color);
    }
}

fn window_ui(ui: &mut Ui, mut head: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let now = pane.state.settings.plot_window;
    let each = (head.width() / 8.0).min(52.0);
    let mut row = take_right(&mut head, each * 8.0);
    let round = CornerRadius::same(theme::ROUND_SMALL);
    ui.painter().rect_filled(row, round, look.palette.sunken);
    for window in PlotWindow::ALL {
        let (place, rest) = row.split_left_right_at_x(row.left() + each);
        row = rest;
        let (text, short) = window_text(window);
        let name = format!("{}: {text}", look.say(panels::WINDOW_NAME));
        let shown = if each < 46.0 { short } else { text };
        let button = Button::new(shown, look.say(panels::WINDOW_TIP))
            .choice(window == now)
            .named(&name);
        let response = button.ground(ui, look, place, Id::unique(("plot window", text)));
        let color = button.text_color(look);
        controls::paint_text(
            ui,
            place,
            Align2::CENTER_CENTER,
            shown,
            theme::small(),
            color,
        );
        if response.clicked() {
            pane.actions.push(Action::PlotWindow(window));
        }
    }
}

const fn window_text(window: PlotWindow) -> (&'static str, &'static str) {
    match window {
        PlotWindow::S5 => ("5 s", "5s"),
        PlotWindow::S10 => ("10 s", "10s"),
        PlotWindow::S30 => ("30 s", "30s"),
        PlotWindow::M1 => ("1 min", "1m"),
        PlotWindow::M5 => ("5 min", "5m"),
        PlotWindow::M10 => ("10 min", "10m"),
        PlotWindow::M30 => ("30 min", "30m"),
        PlotWindow::H1 => ("1 h", "1h"),
    }
}

/// The six joints, each a switch for its curves, and the switch for thresholds; in as many rows as they need.
pub(crate) fn legend_ui(ui: &mut Ui, body: &mut Rect, pane: &Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let widths = Dof::ALL.map(|dof| item_width(ui, look, dof));
    let thresholds = look.say(panels::THRESHOLDS);
    let threshold_width = controls::text_width(ui, thresholds, theme::small()) + 26.0;
    let needed: f32 = widths.iter().map(|width| width + theme::STEP).sum();
    let one_row = needed + threshold_width <= body.width();
    let mut row = take_top(body, ROW);
    if !one_row {
        body.min.y -= theme::STEP;
    }
    let columns = [0, 1, 2].map(|n| {
        let width = |n: usize| widths.get(n).copied().unwrap_or_default();
        width(n).max(width(n + 3))
    });
    let threshold = take_right(&mut row, if one_row { threshold_width } else { 20.0 });
    threshold_ui(ui, threshold, look, view);
    for (n, (dof, width)) in Dof::ALL.into_iter().zip(widths).enumerate() {
        if n == 3 && !one_row {
            row = take_top(body, ROW);
        }
        let column = columns.get(n % 3).copied().unwrap_or(width);
        let width = if one_row { width } else { column };
        let place = take_left(&mut row, width);
        row.min.x -= theme::STEP;
        item_ui(ui, place, look, dof, view);
    }
}

fn item_width(ui: &Ui, look: Look, dof: Dof) -> f32 {
    controls::text_width(ui, look.say(words::dof(dof)), theme::small()) + 21.0
}

fn item_ui(ui: &mut Ui, place: Rect, look: Look, dof: Dof, view: &mut PlotView) {
    let name = look.say(words::dof(dof));
    let shown = !view.hidden[dof];
    let named = format!("{}: {name}", look.say(panels::HISTORY));
    let mut button = Button::new(name, look.say(panels::SHOW_CURVE))
        .weight(Weight::Quiet)
        .named(&named);
    button.selected = Some(shown);
    let response = button.ground(ui, look, place, Id::unique(("legend", dof)));
    let swatch =
        Rect::from_center_size(pos2(place.left() + 9.0, place.center().y), vec2(10.0, 3.0));
    let palette = look.palette;
    let (line, text) = if shown {
        (palette.dof[dof], palette.text)
    } else {
        (palette.edge, palette.faint)
    };
    ui.painter()
        .rect_filled(swatch, CornerRadius::same(1), line);
    legend_text(ui, place, 17.0, name, text);
    if response.clicked() {
        view.hidden[dof] = shown;
    }
}

fn threshold_ui(ui: &mut Ui, place: Rect, look: Look, view: &mut PlotView) {
    let text = look.say(panels::THRESHOLDS);
    let mut button = Button::new(text, look.say(panels::THRESHOLDS_TIP)).weight(Weight::Quiet);
    button.selected = Some(view.thresholds);
    let response = button.ground(ui, look, place, Id::unique("thresholds"));
    let palette = look.palette;
    let color = if view.thresholds {
        palette.text
    } else {
        palette.faint
    };
    let y = place.center().y;
    for (from, to) in [(4.0, 8.0), (11.0, 15.0)] {
        let line = [pos2(place.left() + from, y), pos2(place.left() + to, y)];
        ui.painter().line_segment(line, Stroke::new(1.5, color));
    }
    if place.width() > 24.0 {
        legend_text(ui, place, 20.0, text, color);
    }
    if response.clicked() {
        view.thresholds = !view.thresholds;
    }
}

fn legend_text(ui: &Ui, place: Rect, indent: f32, text: &str, color: Color32) {
    let place = place.with_min_x(place.left() + indent);
    controls::paint_text(ui, place, Align2::LEFT_CENTER, text, theme::small(), color);
}
