//! Force, current, temperature and angle over one time axis. Asks the history for as many columns as there are pixels.

use crate::app::history::{Mark, MarkKind, Quantity, Series, Trace};
use crate::hand::{Dof, PerDof};
use crate::ui::controls::{self, Label};
use crate::ui::look::Pane;
use crate::ui::plot_axes::{self, Band, Extent};
use crate::ui::plot_head;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{Color32, CornerRadius, Rect, Ui, UiBuilder, pos2, vec2};
use egui_plot::{HLine, Line, LineStyle, Plot, PlotPoint, PlotPoints, PlotUi, VLine};

/// Room for the numbers of the vertical axis.
pub(crate) const AXIS: f32 = 40.0;
/// Room for the numbers of the time axis.
const TIME_AXIS: f32 = 20.0;
/// Room for a plot's title.
const CAPTION: f32 = 18.0;
/// Height that a number on the vertical axis needs.
const NUMBER: f32 = 22.0;

/// What the plots need between frames.
#[derive(Debug, Default)]
pub(crate) struct PlotView {
    /// Joints whose curves are hidden.
    pub(crate) hidden: PerDof<bool>,
    /// Whether thresholds are shown.
    pub(crate) thresholds: bool,
    /// Newest time shown while the plots stand still, in seconds.
    pub(crate) held_s: Option<f64>,
    /// The points of one curve as the history gives them, reused from curve to curve.
    trace: Trace,
    /// The points of one plot, reused from plot to plot.
    curves: Curves,
}

/// Curves with their colours, and what they span. Keeps its memory from plot to plot.
#[derive(Debug, Default)]
struct Curves {
    used: usize,
    pool: Vec<(Color32, Vec<PlotPoint>)>,
    extent: Extent,
}

impl Curves {
    fn clear(&mut self) {
        self.used = 0;
        self.extent = Extent::default();
    }

    fn push(&mut self, color: Color32, points: &[[f64; 2]]) {
        if self.used == self.pool.len() {
            self.pool.push((color, Vec::new()));
        }
        if let Some((kept, slot)) = self.pool.get_mut(self.used) {
            *kept = color;
            slot.clear();
            slot.extend(points.iter().map(|[x, y]| PlotPoint { x: *x, y: *y }));
            self.used += 1;
        }
        for [_, value] in points {
            self.extent.include(*value);
        }
    }

    fn iter(&self) -> impl Iterator<Item = &(Color32, Vec<PlotPoint>)> {
        self.pool.iter().take(self.used)
    }
}

/// One of the stacked plots.
struct Panel {
    quantity: Quantity,
    title: Text,
    /// The scale never shows less than this.
    least: (f64, f64),
    /// Steps of the scale.
    steps: [f64; 8],
}

const PANELS: [Panel; 4] = [
    Panel {
        quantity: Quantity::Force,
        title: panels::PLOT_FORCE,
        least: (0.0, 200.0),
        steps: [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0],
    },
    Panel {
        quantity: Quantity::Current,
        title: panels::PLOT_CURRENT,
        least: (0.0, 200.0),
        steps: [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0],
    },
    Panel {
        quantity: Quantity::Temperature,
        title: panels::PLOT_TEMPERATURE,
        least: (20.0, 40.0),
        steps: [5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0],
    },
    Panel {
        quantity: Quantity::Angle,
        title: panels::PLOT_ANGLE,
        least: (0.0, 1000.0),
        steps: [
            250.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0, 20_000.0, 50_000.0,
        ],
    },
];

/// The time and the values that one plot shows.
#[derive(Debug, Clone, Copy)]
struct Sight {
    span: (f64, f64),
    band: Band,
}

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (head, mut body) = controls::titled_card(ui, look, rect, look.say(panels::HISTORY));
        plot_head::head_ui(ui, head, pane, self);
        plot_head::legend_ui(ui, &mut body, pane, self);
        let newest = self.held_s.unwrap_or_else(|| pane.state.now.secs());
        let window = pane.state.settings.plot_window.seconds();
        let span = (newest - window, newest);
        let height = (body.height() - TIME_AXIS) / 4.0;
        let mut top = body.top();
        for panel in &PANELS {
            let place = Rect::from_min_size(pos2(body.left(), top), vec2(body.width(), height));
            self.panel_ui(ui, place, pane, panel, span);
            top += height;
        }
        let axis = Rect::from_min_max(pos2(body.left() + AXIS, top), body.max);
        plot_axes::time_axis_ui(ui, axis, look, window);
        let ground = Rect::from_min_max(pos2(axis.left(), body.top()), axis.right_top());
        pointer_ui(ui, ground, pane, window);
    }

    fn panel_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        span: (f64, f64),
    ) {
        let look = pane.look;
        let (caption, ground) = rect.split_top_bottom_at_y(rect.top() + CAPTION);
        let ground = ground.with_max_y(ground.bottom() - 2.0);
        Label::new(look.say(panel.title), look.palette.muted)
            .small()
            .put(ui, caption);
        let plot_rect = ground.with_min_x(ground.left() + AXIS);
        self.gather(pane, panel.quantity, span, plot_rect.width());
        let mut band = Band::of(panel.least, &self.curves.extent);
        if self.shows_thresholds(panel) {
            for (_, joint) in pane.state.joints.iter() {
                band.include(f64::from(joint.force.get()));
            }
        }
        let band = band.rounded(panel.steps, plot_rect.height() / NUMBER);
        plot_axes::value_axis_ui(ui, ground, look, &band);
        let round = CornerRadius::same(3);
        ui.painter()
            .rect_filled(plot_rect, round, look.palette.sunken);
        plot_axes::grid(ui, plot_rect, look, &band, span.1 - span.0);
        self.plot_ui(ui, plot_rect, pane, panel, Sight { span, band });
        if panel.quantity == Quantity::Force {
            mark_labels(ui, plot_rect, pane, span);
        }
        if self.curves.used == 0 {
            let text = look.say(panels::PLOT_EMPTY);
            let width = controls::text_width(ui, text, theme::small()) + theme::PAD;
            let place = Rect::from_center_size(plot_rect.center(), vec2(width, 16.0));
            ui.painter().rect_filled(place, round, look.palette.sunken);
            Label::new(text, look.palette.faint)
                .small()
                .center()
                .put(ui, place);
        }
    }

    fn shows_thresholds(&self, panel: &Panel) -> bool {
        self.thresholds && panel.quantity == Quantity::Force
    }

    /// Fetches the curves of one quantity, with as many points as the plot is wide.
    fn gather(&mut self, pane: &Pane<'_>, quantity: Quantity, span: (f64, f64), width: f32) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a width in pixels, clamped"
        )]
        let columns = width.clamp(1.0, 8192.0) as usize;
        self.curves.clear();
        for dof in Dof::ALL.into_iter().filter(|dof| !self.hidden[*dof]) {
            let series = Series::Joint(quantity, dof);
            pane.state
                .history
                .trace(series, span.0, span.1, columns, &mut self.trace);
            let color = pane.look.palette.dof[dof];
            for segment in &self.trace.segments {
                self.curves.push(color, segment);
            }
        }
    }

    fn plot_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>, panel: &Panel, sight: Sight) {
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            still_plot(panel.title.en, rect).show(ui, |plot| {
                plot.set_plot_bounds_x(sight.span.0..=sight.span.1);
                plot.set_plot_bounds_y(sight.band.low..=sight.band.high);
                for mark in pane.state.history.marks(sight.span.0, sight.span.1) {
                    let (_, color) = mark_look(pane, &mark.kind);
                    let line = VLine::new("", mark.at.secs()).color(color).width(1.0);
                    plot.vline(line.allow_hover(false));
                }
                if self.shows_thresholds(panel) {
                    threshold_lines(plot, pane);
                }
                for (color, points) in self.curves.iter() {
                    let line = Line::new("", PlotPoints::Borrowed(points));
                    plot.line(line.color(*color).width(theme::LINE).allow_hover(false));
                }
            });
        });
    }
}

/// A plot that nothing moves but time.
fn still_plot<'a>(name: &str, rect: Rect) -> Plot<'a> {
    Plot::new(("history", name))
        .width(rect.width())
        .height(rect.height())
        .show_axes(false)
        .show_grid(false)
        .show_background(false)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_axis_zoom_drag(false)
        .show_crosshair(false)
        .set_margin_fraction(vec2(0.0, 0.0))
        .sense(egui::Sense::hover())
}

/// A line through all plots where the pointer is, with its time.
fn pointer_ui(ui: &Ui, ground: Rect, pane: &Pane<'_>, window_s: f64) {
    let Some(pointer) = ui
        .ctx()
        .pointer_hover_pos()
        .filter(|at| ground.contains(*at))
    else {
        return;
    };
    let palette = pane.look.palette;
    let line = egui::Stroke::new(1.0, palette.faint);
    ui.painter().vline(pointer.x, ground.y_range(), line);
    let part = f64::from((ground.right() - pointer.x) / ground.width());
    let text = format!("-{:.2} s", part * window_s);
    let center = pos2(pointer.x, ground.bottom() + TIME_AXIS / 2.0);
    let center = pos2(
        center.x.clamp(ground.left() + 32.0, ground.right() - 32.0),
        center.y,
    );
    let place = Rect::from_center_size(center, vec2(64.0, 16.0));
    let round = CornerRadius::same(3);
    ui.painter().rect_filled(place, round, palette.control);
    let align = egui::Align2::CENTER_CENTER;
    let font = theme::number_small();
    controls::paint_text(ui, place, align, &text, font, palette.text);
}

fn threshold_lines(plot: &mut PlotUi<'_>, pane: &Pane<'_>) {
    for (dof, joint) in pane.state.joints.iter() {
        let color = pane.look.palette.dof[dof].gamma_multiply(0.7);
        let line = HLine::new("", f64::from(joint.force.get()))
            .color(color)
            .width(1.0)
            .style(LineStyle::Dashed { length: 5.0 });
        plot.hline(line.allow_hover(false));
    }
}

fn mark_look(pane: &Pane<'_>, kind: &MarkKind) -> (Text, Color32) {
    let palette = pane.look.palette;
    match kind {
        MarkKind::Armed => (panels::MARK_ARMED, palette.armed),
        MarkKind::Stop => (panels::MARK_STOP, palette.bad),
        MarkKind::HoldConfirmed => (panels::MARK_HELD, palette.ok),
        MarkKind::Fault => (panels::MARK_FAULT, palette.warn),
        MarkKind::LinkLost => (panels::MARK_LOST, palette.bad),
        MarkKind::Reconnected => (panels::MARK_RECONNECT, palette.ok),
        MarkKind::Gesture(_) => (panels::MARK_GESTURE, palette.accent),
        MarkKind::Note(_) => (panels::MARK_NOTE, palette.text),
    }
}

/// The words of the marks, once, in the topmost plot. Words that would overlap are left out.
fn mark_labels(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, span: (f64, f64)) {
    let mut free_from = rect.left();
    for mark in pane.state.history.marks(span.0, span.1) {
        let (text, color) = mark_look(pane, &mark.kind);
        let text = mark_text(pane, mark, text);
        let x = plot_axes::x_of(rect, span, mark.at.secs());
        let width = controls::text_width(ui, &text, theme::small()) + 1.0;
        let flipped = x + width + 6.0 > rect.right();
        let left = if flipped { x - width - 4.0 } else { x + 4.0 };
        if left < free_from {
            continue;
        }
        let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), vec2(width, 14.0));
        let ground = pane.look.palette.sunken.gamma_multiply(0.8);
        let round = CornerRadius::same(2);
        ui.painter()
            .rect_filled(place.expand2(vec2(2.0, 0.0)), round, ground);
        Label::new(&text, color).small().put(ui, place);
        free_from = left + width + theme::GAP;
    }
}

fn mark_text(pane: &Pane<'_>, mark: &Mark, text: Text) -> String {
    let text = pane.look.say(text);
    match &mark.kind {
        MarkKind::Gesture(number) => format!("{text} {number}"),
        _ => text.to_owned(),
    }
}
