//! Stacked plots over a common time range: measurements, events, and the figures between two cursors.
pub(crate) mod chart;
pub(crate) mod cursors;
pub(crate) mod drives;
pub(crate) mod ends;
pub(crate) mod head;
pub(crate) mod legend;
pub(crate) mod marks;
pub(crate) mod notes;
pub(crate) mod panels;
pub(crate) mod scales;
pub(crate) mod time_window;
pub(crate) mod times;

use crate::app::action::Action;
use crate::app::settings::PlotKind;
use crate::hand::{Dof, PerDof};
use crate::history::Series;
use crate::transport::Endpoint;
use crate::ui::kit::{self, Label, Look, Pane, dash};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartResponse, ChartView, Points};
use crate::ui::plots::cursors::Cursors;
use crate::ui::plots::drives::DrivesPlace;
use crate::ui::plots::ends::{CurveEnd, PlotEnds};
use crate::ui::plots::panels::{PANELS, Panel, PanelLine};
use crate::ui::plots::scales::joined;
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::text::panels as text;
use crate::ui::theme;
use egui::{Align2, Role, Stroke, Ui, WidgetInfo, pos2};

/// Opacity of setpoints, paler than measurements.
const WISHED_PART: f32 = 0.45;
/// Opacity of all joints except the one whose value is hovered.
const BEHIND_PART: f32 = 0.2;
/// Height of a sparkline: its name and its unit.
const SPARKLINE: f32 = 32.0;
/// Minimum height of a tall plot: its title, and the values of six joints at the ends of their curves.
const TALL_LEAST: f32 = 104.0;
/// Height of a window from which on all plots are tall, if they fit.
const ALL_FROM: f32 = 900.0;
/// Available height below which only one plot is shown.
const ALONE_BELOW: f32 = 72.0;

/// Position and size of one plot.
struct PlotPlace {
    height: f32,
    /// Space at its right.
    end: f32,
    is_lowest: bool,
    is_sparkline: bool,
}

/// View state of the plots.
#[derive(Debug, Default)]
pub(crate) struct PlotView {
    /// Time range and scales.
    pub(crate) view: ChartView,
    /// Joints whose curves are hidden.
    hidden: PerDof<bool>,
    /// Joint whose value is hovered.
    pointed: Option<Dof>,
    /// True while thresholds are shown.
    thresholds: bool,
    cursors: Cursors,
    /// Plot whose figures are shown.
    chosen: Option<PlotKind>,
    /// True while the plots fill the view.
    pub(crate) large: bool,
    /// Width and height of the card in points, for saving it as a picture.
    size: (f32, f32),
    /// Hand that is shown.
    hand: Option<Endpoint>,
}

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.advance(pane);
        self.size = ui.available_size().into();
        kit::card_ui(ui, pane.look, |ui| {
            head::head_ui(ui, pane, self);
            self.body_ui(ui, pane);
        });
    }

    /// Shows exactly this time range.
    pub(crate) const fn pin(&mut self, span: TimeSpan) {
        self.view.time.pin(span);
    }

    /// Advances the time. On a change of hand, follows the newest values and resets the cursors.
    fn advance(&mut self, pane: &Pane<'_>) {
        let hand = pane.hand();
        if self.hand != hand.connection.endpoint && hand.connection.endpoint.is_some() {
            self.hand.clone_from(&hand.connection.endpoint);
            self.view.time.follow();
            self.cursors = Cursors::default();
        }
        let window = pane.state.settings.plot_window.seconds();
        let now_s = pane.state.now.secs();
        self.view.advance(&hand.measured.history, now_s, window);
    }

    fn body_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let plots = &pane.state.settings.plots;
        let shown = PANELS.iter().filter(|panel| plots.shows(panel.kind));
        let shown: Vec<&Panel> = shown.collect();
        let is_chosen = |panel: &&Panel| Some(panel.kind) == self.chosen;
        let at = shown.iter().position(is_chosen).unwrap_or_default();
        let Some(chosen) = shown.get(at).copied() else {
            return;
        };
        let has_figures = self.cursors.0.is_some();
        if has_figures {
            let measured = chosen.measured(&self.hidden);
            let table = egui::Panel::bottom("figures of the cursors").frame(egui::Frame::NONE);
            let table = table
                .show_separator_line(false)
                .show(ui, |ui| self.cursors.table_ui(ui, pane, chosen, &measured));
            if table.inner {
                let next = shown.get(at + 1).or(shown.first());
                self.chosen = next.map(|panel| panel.kind);
            }
        }
        ui.spacing_mut().item_spacing.y = 0.0;
        let joints = Dof::ALL.into_iter().filter(|dof| !self.hidden[*dof]);
        let joints: Vec<Dof> = joints.collect();
        let has_words = ui.ctx().content_rect().height() >= ALL_FROM;
        let low = drives::height(joints.len(), has_words);
        let (tall, height) = Self::tall(ui, pane, shown.len(), low);
        let tall = match tall.len() {
            1 if has_figures => vec![chosen.kind],
            _ => tall,
        };
        let least = if has_figures { TALL_LEAST } else { ALONE_BELOW };
        let is_alone = height < least;
        let (shown, tall, height) = match is_alone {
            true => (vec![chosen], vec![chosen.kind], room(ui, 1)),
            false => (shown, tall, height),
        };
        // In a window that was forced to be tiny there is no space to draw in.
        let end = ends::width(ui);
        if height <= theme::PLOT_CAPTION + theme::PLOT_NUMBER
            || ui.available_width() <= 4.0 * theme::PLOT_AXIS + end
        {
            return;
        }
        let (tall, low): (Vec<&Panel>, Vec<&Panel>) = shown
            .into_iter()
            .partition(|panel| tall.contains(&panel.kind));
        self.tall_ui(ui, pane, &tall, height);
        for panel in low {
            self.sparkline_ui(ui, pane, panel, end);
        }
        if !is_alone {
            let place = DrivesPlace {
                joints: &joints,
                has_words,
                span: self.view.time.span(),
                end,
                pointed_s: self.view.pointed_s(),
            };
            place.ui(ui, pane);
        }
    }

    /// Chooses the tall plots out of the `shown` ones, and their height, with `below` points used below: all in a high window, else
    /// two if they fit.
    fn tall(ui: &Ui, pane: &Pane<'_>, shown: usize, below: f32) -> (Vec<PlotKind>, f32) {
        let height = |tall: usize| tall_height(ui, tall, shown - tall, below);
        let is_high = ui.ctx().content_rect().height() >= ALL_FROM;
        let count = match shown {
            0 | 1 => shown,
            _ if is_high && height(shown) >= TALL_LEAST => shown,
            _ if height(2) >= TALL_LEAST => 2,
            _ => 1,
        };
        let settings = &pane.state.settings;
        let tall = settings.tall_plots.of(&settings.plots, count);
        (tall, height(count))
    }

    /// Draws the tall plots over a common time axis.
    fn tall_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, shown: &[&Panel], height: f32) {
        let (end, mut pointed) = (ends::width(ui), None);
        for (n, panel) in shown.iter().enumerate() {
            let is_lowest = n + 1 == shown.len();
            let place = PlotPlace {
                height: chart::height_over_axis(height, is_lowest),
                end,
                is_lowest,
                is_sparkline: false,
            };
            let chart = self.panel_ui(ui, pane, panel, &place);
            if n == 0 {
                marks::words_ui(ui, pane, &chart);
            }
            if is_lowest {
                self.cursors.flags_ui(ui, pane.look, &chart);
            }
            let ends = PlotEnds {
                look: pane.look,
                panel,
                chart: &chart,
            };
            pointed = pointed.or(ends.ui(ui, &self.ends(pane, panel)));
            if chart.response.clicked() {
                self.chosen = Some(panel.kind);
            }
            if let Some(marks) = marks::near(pane, &chart) {
                chart.response.on_hover_text_at_pointer(marks);
            }
        }
        self.pointed = pointed.map(|(dof, _)| dof);
        if let Some((dof, true)) = pointed {
            self.hidden[dof] = true;
        }
    }

    /// Newest values of a plot, at its right edge.
    fn ends(&self, pane: &Pane<'_>, panel: &Panel) -> Vec<CurveEnd> {
        let history = &pane.hand().measured.history;
        let (_, to_s) = self.view.time.span();
        let end = |line: PanelLine| {
            let reading = history.reading(line.series, to_s);
            CurveEnd {
                dof: line.dof,
                value: reading.map(|reading| reading.value.into()),
                color: self.stroke(pane.look, &line).color,
            }
        };
        panel.measured(&self.hidden).into_iter().map(end).collect()
    }

    /// Draws a plot reduced to its curves, with its name and the range of its newest values.
    fn sparkline_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, panel: &Panel, end: f32) {
        let look = pane.look;
        let place = PlotPlace {
            height: SPARKLINE,
            end,
            is_lowest: false,
            is_sparkline: true,
        };
        ui.add_space(theme::STEP);
        let chart = self.panel_ui(ui, pane, panel, &place);
        let frame = *chart.transform.frame();
        let name = look.pair(look.tr(text::GROW), look.tr(panel.title));
        let grow = chart.inner;
        grow.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        let at = pos2(frame.left() - theme::STEP, frame.center().y);
        let color = if grow.hovered() {
            look.palette.text
        } else {
            look.palette.muted
        };
        let short = look.tr(panel.short).to_owned();
        ui.painter()
            .text(at, Align2::RIGHT_CENTER, short, theme::small(), color);
        let values = self.ends(pane, panel).into_iter();
        let values = values.filter_map(|end| end.value);
        if let Some((low, high)) = values.fold(None, |all, value| joined(all, (value, value))) {
            let digits = panel.row.decimals;
            let (low, high) = (format!("{low:.digits$}"), format!("{high:.digits$}"));
            let place = frame.with_min_x(frame.right() + theme::STEP);
            let place = place.with_max_x(frame.right() + ends::VALUES);
            let both = format!("{low}…{high}");
            let fits = kit::text_width(ui, &both, theme::number()) <= place.width();
            let text = if fits && low != high { both } else { high };
            Label::new(&text, color).number().right().paint(ui, place);
        }
        if chart.response.clicked() || grow.clicked() {
            self.chosen = Some(panel.kind);
            pane.actions.push(Action::GrowPlot(panel.kind));
        }
        let tip = format!("{}\n{}", look.tr(panel.title), look.tip(text::GROW));
        grow.on_hover_text(tip);
    }

    fn panel_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        panel: &Panel,
        place: &PlotPlace,
    ) -> ChartResponse {
        let look = pane.look;
        let hand = pane.hand();
        let curve_of = |history, line: &PanelLine| {
            let points = Points::Measured(history, line.series);
            ChartCurve::new(points, self.stroke(look, line))
        };
        let curve = |line: &PanelLine| ChartCurve {
            steps: line.wished,
            decimals: (!line.wished).then_some(panel.row.decimals),
            ..curve_of(&hand.measured.history, line)
        };
        let lines = panel.lines(&self.hidden);
        // The second recording is drawn behind the first.
        let beside = pane.state.beside.iter().flat_map(|beside| {
            let measured = lines.iter().filter(|line| !line.wished);
            measured.map(|line| ChartCurve {
                zero: [beside.offset_s(), 0.0],
                style: dash::nth(1),
                beside: true,
                ..curve_of(&beside.history, line)
            })
        });
        let mut levels = Vec::new();
        if self.thresholds && panel.kind == PlotKind::Force {
            let shown = Dof::ALL.into_iter().filter(|dof| !self.hidden[*dof]);
            let level = |dof: Dof| {
                let stops_at = hand.controls.stops_at(dof, hand.held_otherwise(dof))?;
                Some((stops_at.get().into(), look.palette.dof[dof]))
            };
            levels.extend(shown.filter_map(level));
        }
        let span = self.view.time.span();
        let chart = Chart {
            curves: beside.chain(lines.iter().map(curve)).collect(),
            levels,
            moments: marks::moments(pane, span),
            cursors: self.cursors.0,
            least: panel.row.least_scale,
            times: self.view.times(look),
            is_lowest: place.is_lowest,
            end: place.end,
            is_sparkline: place.is_sparkline,
            ..Chart::new(look, panel.title, place.height)
        };
        chart.ui(ui, &mut self.view)
    }

    fn stroke(&self, look: Look, line: &PanelLine) -> Stroke {
        let color = look.palette.dof[line.dof];
        let color = match self.pointed {
            Some(dof) if dof != line.dof => color.gamma_multiply(BEHIND_PART),
            _ => color,
        };
        if line.wished {
            Stroke::new(1.0, color.gamma_multiply(WISHED_PART))
        } else {
            Stroke::new(theme::LINE, color)
        }
    }

    /// Size of the card, for saving it as a picture.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a length on a screen, cut to the ends of the whole numbers"
    )]
    const fn pixels(&self) -> (u32, u32) {
        (self.size.0 as u32, self.size.1 as u32)
    }

    /// Series of all shown plots and joints, for copying and saving.
    fn shown_series(&self, pane: &Pane<'_>) -> Vec<Series> {
        let plots = &pane.state.settings.plots;
        let panels = PANELS.iter().filter(|panel| plots.shows(panel.kind));
        let lines = panels.flat_map(|panel| panel.lines(&self.hidden));
        lines.map(|line| line.series).collect()
    }
}

/// Height of each tall plot, beside `low` sparklines and with `below` points used below.
fn tall_height(ui: &Ui, tall: usize, low: usize, below: f32) -> f32 {
    let count = |count: usize| f32::from(u8::try_from(count).unwrap_or(u8::MAX));
    let room = ui.available_height() - theme::PLOT_TIME_AXIS - below;
    ((room - count(low) * (SPARKLINE + theme::STEP)) / count(tall.max(1))).floor()
}

/// Height of each of `count` plots above their time axis.
pub(crate) fn room(ui: &Ui, count: usize) -> f32 {
    let count = f32::from(u8::try_from(count).unwrap_or(u8::MAX));
    ((ui.available_height() - theme::PLOT_TIME_AXIS) / count).floor()
}
