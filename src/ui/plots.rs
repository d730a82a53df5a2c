//! Force, current, temperature and angle over one time axis. Asks the history for as many columns as there are pixels.

use crate::app::action::Action;
use crate::app::history::{Mark, MarkKind, Quantity, Series, Trace};
use crate::app::settings::PlotWindow;
use crate::hand::{Dof, PerDof};
use crate::ui::controls::{self, Button, Label, Weight, take_left, take_right};
use crate::ui::look::Pane;
use crate::ui::plot_axes::{self, Band};
use crate::ui::text::{Text, panels, words};
use crate::ui::theme;
use egui::{Color32, CornerRadius, Id, Rect, Ui, UiBuilder, pos2, vec2};
use egui_plot::{HLine, Line, LineStyle, Plot, PlotPoint, PlotPoints, VLine};

/// Room for the numbers of the vertical axis.
pub(crate) const AXIS: f32 = 40.0;
/// Room for the numbers of the time axis.
const TIME_AXIS: f32 = 20.0;
/// Room for a plot's title.
const CAPTION: f32 = 18.0;

/// What the plots need between frames.
#[derive(Debug, Default)]
pub(crate) struct PlotView {
    /// Joints whose curves are hidden.
    hidden: PerDof<bool>,
    /// Whether thresholds are shown.
    thresholds: bool,
    /// Newest time shown while paused, in seconds.
    held_s: Option<f64>,
    /// The points of one curve, reused from curve to curve.
    trace: Trace,
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

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (mut head, mut body) = controls::titled_card(ui, look, rect, look.say(panels::HISTORY));
        pause_ui(ui, &mut head, pane);
        window_ui(ui, &mut head, pane);
        let legend = controls::take_top(&mut body, 20.0);
        self.legend_ui(ui, legend, pane);
        let newest = self.newest_s(pane);
        let window = pane.state.settings.plot_window.seconds();
        let span = (newest - window, newest);
        let marks: Vec<Mark> = pane.state.history.marks(span.0, span.1).to_vec();
        let height = (body.height() - TIME_AXIS) / 4.0;
        let mut top = body.top();
        for panel in &PANELS {
            let place = Rect::from_min_size(pos2(body.left(), top), vec2(body.width(), height));
            self.panel_ui(ui, place, pane, panel, span, &marks);
            top += height;
        }
        let axis = Rect::from_min_max(pos2(body.left() + AXIS, top), body.max);
        plot_axes::time_axis_ui(ui, axis, look, window);
    }

    /// The right edge of the plots; stands still while paused.
    fn newest_s(&mut self, pane: &Pane<'_>) -> f64 {
        let now = pane.state.now.secs();
        if !pane.state.history.is_paused() {
            self.held_s = None;
            return now;
        }
        *self.held_s.get_or_insert(now)
    }

    fn legend_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let mut rest = rect;
        let thresholds = look.say(panels::THRESHOLDS);
        let width = controls::text_width(ui, thresholds, theme::small()) + 26.0;
        let place = take_right(&mut rest, width);
        let mut button =
            Button::new(thresholds, look.say(panels::THRESHOLDS_TIP)).weight(Weight::Quiet);
        button.selected = Some(self.thresholds);
        let response = button.ground(ui, look, place, Id::unique("thresholds"));
        let color = if self.thresholds {
            look.palette.text
        } else {
            look.palette.faint
        };
        dashes(ui, place, color);
        legend_text(ui, place, 20.0, thresholds, color);
        if response.clicked() {
            self.thresholds = !self.thresholds;
        }
        for dof in Dof::ALL {
            let name = look.say(words::dof(dof));
            let wanted = controls::text_width(ui, name, theme::small()) + 21.0;
            let width = wanted.min(rest.width());
            let place = take_left(&mut rest, width);
            rest.min.x -= theme::STEP;
            let mut button = Button::new(name, look.say(panels::SHOW_CURVE)).weight(Weight::Quiet);
            let named = format!("{}: {name}", look.say(panels::HISTORY));
            button.selected = Some(!self.hidden[dof]);
            let response =
                button
                    .named(&named)
                    .ground(ui, look, place, Id::unique(("legend", dof)));
            let shown = !self.hidden[dof];
            let swatch =
                Rect::from_center_size(pos2(place.left() + 9.0, place.center().y), vec2(10.0, 3.0));
            let line = if shown {
                look.palette.dof[dof]
            } else {
                look.palette.edge
            };
            ui.painter()
                .rect_filled(swatch, CornerRadius::same(1), line);
            let color = if shown {
                look.palette.text
            } else {
                look.palette.faint
            };
            legend_text(ui, place, 17.0, name, color);
            if response.clicked() {
                self.hidden[dof] = shown;
            }
        }
    }

    fn panel_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        span: (f64, f64),
        marks: &[Mark],
    ) {
        let look = pane.look;
        let (caption, ground) = rect.split_top_bottom_at_y(rect.top() + CAPTION);
        let ground = ground.with_max_y(ground.bottom() - 2.0);
        Label::new(look.say(panel.title), look.palette.muted)
            .small()
            .put(ui, caption);
        let plot_rect = ground.with_min_x(ground.left() + AXIS);
        let lines = self.lines(pane, panel.quantity, span, plot_rect.width());
        let mut band = Band::of(panel.least, &lines.extent);
        if self.thresholds && panel.quantity == Quantity::Force {
            for (_, joint) in pane.state.joints.iter() {
                band.include(f64::from(joint.force.get()));
            }
        }
        let band = band.rounded(panel.steps);
        plot_axes::value_axis_ui(ui, ground, look, &band);
        ui.painter()
            .rect_filled(plot_rect, CornerRadius::same(3), look.palette.sunken);
        plot_axes::grid(ui, plot_rect, look, &band, span.1 - span.0);
        let empty = lines.curves.is_empty();
        self.plot_ui(ui, plot_rect, pane, panel, (span, band), lines, marks);
        if empty {
            Label::new(look.say(panels::PLOT_EMPTY), look.palette.faint)
                .small()
                .center()
                .put(ui, plot_rect);
        }
    }

    /// The curves of one quantity, as many points as the plot is wide, and what they span.
    fn lines(
        &mut self,
        pane: &Pane<'_>,
        quantity: Quantity,
        span: (f64, f64),
        width: f32,
    ) -> Curves {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a width in pixels, clamped"
        )]
        let columns = width.clamp(1.0, 8192.0) as usize;
        let mut curves = Curves::default();
        for dof in Dof::ALL {
            if self.hidden[dof] {
                continue;
            }
            let series = Series { quantity, dof };
            pane.state
                .history
                .trace(series, span.0, span.1, columns, &mut self.trace);
            let color = pane.look.palette.dof[dof];
            for segment in &self.trace.segments {
                let points: Vec<PlotPoint> = segment
                    .iter()
                    .map(|[at, value]| PlotPoint { x: *at, y: *value })
                    .collect();
                for point in &points {
                    curves.extent.include(point.y);
                }
                curves.curves.push((color, points));
            }
        }
        curves
    }

    fn plot_ui(
        &self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        (span, band): ((f64, f64), Band),
        lines: Curves,
        marks: &[Mark],
    ) {
        let look = pane.look;
        let thresholds = self.thresholds && panel.quantity == Quantity::Force;
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            Plot::new(("history", panel.title.en))
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
                .show(ui, |plot| {
                    plot.set_plot_bounds_x(span.0..=span.1);
                    plot.set_plot_bounds_y(band.low..=band.high);
                    for mark in marks {
                        let (_, color) = mark_look(pane, mark.kind);
                        let line = VLine::new("", mark.at_s).color(color).width(1.0);
                        plot.vline(line.allow_hover(false));
                    }
                    if thresholds {
                        for (dof, joint) in pane.state.joints.iter() {
                            let y = f64::from(joint.force.get());
                            let color = look.palette.dof[dof].gamma_multiply(0.7);
                            let line = HLine::new("", y).color(color).width(1.0);
                            let style = LineStyle::Dashed { length: 5.0 };
                            plot.hline(line.style(style).allow_hover(false));
                        }
                    }
                    for (color, points) in lines.curves {
                        let line = Line::new("", PlotPoints::Owned(points));
                        plot.line(line.color(color).width(theme::LINE).allow_hover(false));
                    }
                });
        });
        if panel.quantity == Quantity::Force {
            mark_labels(ui, rect, pane, marks, span);
        }
    }
}

/// Curves with their colours, and what they span.
#[derive(Default)]
struct Curves {
    curves: Vec<(Color32, Vec<PlotPoint>)>,
    extent: plot_axes::Extent,
}

fn mark_look(pane: &Pane<'_>, kind: MarkKind) -> (Text, Color32) {
    let palette = pane.look.palette;
    match kind {
        MarkKind::Stop => (panels::MARK_STOP, palette.bad),
        MarkKind::Fault => (panels::MARK_FAULT, palette.warn),
        MarkKind::Reconnect => (panels::MARK_RECONNECT, palette.muted),
        MarkKind::Gesture(_) => (panels::MARK_GESTURE, palette.accent),
    }
}

/// The words of the marks, once, in the topmost plot. Words that would overlap are left out.
fn mark_labels(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, marks: &[Mark], span: (f64, f64)) {
    let mut free_from = rect.left();
    for mark in marks {
        let part = (mark.at_s - span.0) / (span.1 - span.0);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "0..=1 of a width in pixels"
        )]
        let x = rect.left() + rect.width() * part as f32;
        let (text, color) = mark_look(pane, mark.kind);
        let mut text = pane.look.say(text).to_owned();
        if let MarkKind::Gesture(gesture) = mark.kind {
            text = format!("{text} {}", gesture.get());
        }
        let width = controls::text_width(ui, &text, theme::small()) + 1.0;
        let left = if x + width + 6.0 > rect.right() {
            x - width - 4.0
        } else {
            x + 4.0
        };
        if left < free_from {
            continue;
        }
        let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), vec2(width, 14.0));
        Label::new(&text, color).small().put(ui, place);
        free_from = left + width + theme::GAP;
    }
}

fn dashes(ui: &Ui, place: Rect, color: Color32) {
    let y = place.center().y;
    for (from, to) in [(4.0, 8.0), (11.0, 15.0)] {
        let line = [pos2(place.left() + from, y), pos2(place.left() + to, y)];
        ui.painter()
            .line_segment(line, egui::Stroke::new(1.5, color));
    }
}

fn legend_text(ui: &Ui, place: Rect, indent: f32, text: &str, color: Color32) {
    let place = place.with_min_x(place.left() + indent);
    let align = egui::Align2::LEFT_CENTER;
    controls::paint_text(ui, place, align, text, theme::small(), color);
}

fn pause_ui(ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let paused = pane.state.history.is_paused();
    let text = look.say(if paused {
        panels::PAUSED
    } else {
        panels::PAUSE
    });
    let place = take_right(head, 68.0);
    let mut button = Button::new(text, look.say(panels::PAUSE_TIP))
        .named(look.say(panels::PAUSE_NAME))
        .weight(if paused {
            Weight::Armed
        } else {
            Weight::Normal
        });
    button.selected = Some(paused);
    if button
        .put(ui, look, place, Id::unique("pause plots"))
        .clicked()
    {
        pane.actions.push(Action::PausePlots(!paused));
    }
}

fn window_ui(ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let now = pane.state.settings.plot_window;
    let each = ((head.width() - theme::GAP) / 6.0).min(52.0);
    let mut row = take_right(head, each * 6.0);
    ui.painter().rect_filled(
        row,
        CornerRadius::same(theme::ROUND_SMALL),
        look.palette.sunken,
    );
    for window in PlotWindow::ALL {
        let (place, rest) = row.split_left_right_at_x(row.left() + each);
        row = rest;
        let text = window_text(window);
        let name = format!("{}: {text}", look.say(panels::WINDOW_NAME));
        let short = if each < 44.0 {
            text.replace(' ', "")
        } else {
            text.to_owned()
        };
        let button = Button::new(&short, look.say(panels::WINDOW_TIP))
            .choice(window == now)
            .named(&name);
        if button
            .put(ui, look, place, Id::unique(("plot window", text)))
            .clicked()
        {
            pane.actions.push(Action::PlotWindow(window));
        }
    }
}

const fn window_text(window: PlotWindow) -> &'static str {
    match window {
        PlotWindow::S5 => "5 s",
        PlotWindow::S10 => "10 s",
        PlotWindow::S30 => "30 s",
        PlotWindow::M1 => "1 min",
        PlotWindow::M5 => "5 min",
        PlotWindow::M10 => "10 min",
    }
}
