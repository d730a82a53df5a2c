//! The only plot widget of the program: curves over time in `egui_plot`, with its missing features added. Independent of the hand.

use crate::draw::plot_line;
use crate::history::{History, Series, Trace};
use crate::ui::kit::{self, Label, Look, format};
use crate::ui::plots::scales::{self, ScaleAxis, Scales};
use crate::ui::plots::time_window::{TimeSpan, TimeWindow};
use crate::ui::plots::times::{Times, marks};
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{
    Align, Color32, Layout, Mesh, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke, Ui,
    WidgetInfo, vec2,
};
use egui_plot::{
    AxisHints, GridInput, HLine, Line, LineStyle, Plot, PlotBounds, PlotPoints, PlotResponse,
    PlotTransform, PlotUi, VLine,
};
use std::collections::HashMap;

/// Maximum number of pixel columns of a chart.
const COLUMNS_MOST: f32 = 8192.0;
/// A zoom box lower than this share of the chart's height selects time only.
const BOX_LEAST: f64 = 0.15;
/// Minimum width of a title beside the values under the pointer.
const TITLE_LEAST: f32 = 64.0;

/// Source of a curve's points: seconds and values, oldest first.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Points<'a> {
    /// A measured series, reduced to the number of pixel columns.
    Measured(&'a History, Series),
    /// The given points.
    Own(&'a [[f64; 2]]),
}

/// One curve of a chart.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChartCurve<'a> {
    /// Source of its points.
    pub(crate) points: Points<'a>,
    /// Time and value subtracted from each point.
    pub(crate) zero: [f64; 2],
    /// Width and colour.
    pub(crate) stroke: Stroke,
    /// Line style.
    pub(crate) style: LineStyle,
    /// True if a value holds until the next one, as setpoints do: nothing was requested in between.
    pub(crate) steps: bool,
    /// Decimals of the value shown at the pointer; `None` hides it.
    pub(crate) decimals: Option<usize>,
    /// True for a curve of the second recording: its points are cached separately.
    pub(crate) beside: bool,
}

impl<'a> ChartCurve<'a> {
    /// A plain curve of measurements.
    pub(crate) fn measured(history: &'a History, series: Series, color: Color32) -> Self {
        let stroke = Stroke::new(theme::LINE, color);
        Self::new(Points::Measured(history, series), stroke)
    }

    /// A plain curve.
    pub(crate) const fn new(points: Points<'a>, stroke: Stroke) -> Self {
        Self {
            points,
            zero: [0.0, 0.0],
            stroke,
            style: LineStyle::Solid,
            steps: false,
            decimals: None,
            beside: false,
        }
    }

    /// Its unbroken segments.
    fn pieces<'b>(&'b self, traces: &'b Traces) -> Vec<(&'b Self, &'b [[f64; 2]])> {
        match self.points {
            Points::Own(points) => vec![(self, points)],
            Points::Measured(_, series) => {
                let pieces = traces.get(&(self.beside, series)).into_iter();
                let pieces = pieces.flat_map(|trace| &trace.segments);
                pieces.map(|piece| (self, piece.as_slice())).collect()
            }
        }
    }

    /// True if a pixel column holds more than one point of a segment.
    fn is_dense(&self, piece: &[[f64; 2]], per_s: f64) -> bool {
        let ends = piece.first().zip(piece.last());
        let columns = ends.map_or(0.0, |(first, last)| (last[0] - first[0]) * per_s);
        let count = f64::from(u32::try_from(piece.len()).unwrap_or(u32::MAX));
        self.style == LineStyle::Solid && count > columns + 2.0
    }

    fn line(&self, piece: &[[f64; 2]]) -> Line<'static> {
        let mut before = None;
        let points = piece.iter().flat_map(|[at_s, value]| {
            let (at_s, value) = (at_s - self.zero[0], value - self.zero[1]);
            let corner = before.replace(value).filter(|_| self.steps);
            corner
                .map(|before| [at_s, before])
                .into_iter()
                .chain([[at_s, value]])
        });
        let line = Line::new("", points.collect::<PlotPoints<'_>>()).stroke(self.stroke);
        line.style(self.style).allow_hover(false).allow_band(false)
    }

    fn places(&self, piece: &[[f64; 2]], transform: &PlotTransform) -> impl Iterator<Item = Pos2> {
        let [left, bottom] = transform.bounds().min();
        let [across, up] = transform.dpos_dvalue();
        let corner = transform.frame().left_bottom();
        piece.iter().map(move |[at_s, value]| {
            let x = (at_s - self.zero[0] - left) * across;
            let y = (value - self.zero[1] - bottom) * up;
            #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
            let way = vec2(x as f32, y as f32);
            corner + way
        })
    }
}

type Traces = HashMap<(bool, Series), Trace>;

/// View state of charts that share a time axis.
#[derive(Debug, Default)]
pub(crate) struct ChartView {
    /// Visible time range.
    pub(crate) time: TimeWindow,
    /// Scales set by the user.
    pub(crate) scales: Scales,
    /// Cached points of the curves; only the newest are fetched for a growing curve.
    traces: Traces,
    /// Title of the chart under the pointer, and the pointer's position as a share of its width.
    pointed: Option<(&'static str, f64)>,
}

/// A chart of one quantity.
pub(crate) struct Chart<'a> {
    pub(crate) look: Look,
    /// Title with unit; unique among the charts that share a view.
    pub(crate) title: Text,
    /// Curves, the foremost last.
    pub(crate) curves: Vec<ChartCurve<'a>>,
    /// Reference values, drawn as dashed lines.
    pub(crate) levels: Vec<(f64, Color32)>,
    /// Moments in seconds, drawn as vertical lines.
    pub(crate) moments: Vec<(f64, Color32)>,
    /// Seconds of two cursors.
    pub(crate) cursors: Option<[f64; 2]>,
    /// Value range that is always visible.
    pub(crate) least: (f64, f64),
    /// Format of the times.
    pub(crate) times: Times,
    /// True if the time axis is drawn below this chart.
    pub(crate) is_lowest: bool,
    /// Text shown without any curve.
    pub(crate) empty: Text,
    /// Height with caption and time axis, in points.
    pub(crate) height: f32,
    /// Space at the right, for half of a time label or for the values at the ends of the curves.
    pub(crate) end: f32,
    /// True to omit caption and numbers.
    pub(crate) is_sparkline: bool,
}

/// Height of one of several charts over a common time axis, which is drawn below the lowest.
pub(crate) const fn height_over_axis(height: f32, is_lowest: bool) -> f32 {
    let axis = if is_lowest {
        theme::PLOT_TIME_AXIS
    } else {
        0.0
    };
    height + axis
}

/// The chart as drawn, with the response of the numbers beside it.
pub(crate) type ChartResponse = PlotResponse<Response>;

/// Time at the pointer, in seconds; `None` if the pointer is elsewhere.
pub(crate) fn pointed_s(shown: &ChartResponse) -> Option<f64> {
    let at = shown.response.hover_pos()?;
    Some(shown.transform.value_from_position(at).x)
}

impl<'a> Chart<'a> {
    /// An empty chart.
    pub(crate) const fn new(look: Look, title: Text, height: f32) -> Self {
        Self {
            look,
            title,
            curves: Vec::new(),
            levels: Vec::new(),
            moments: Vec::new(),
            cursors: None,
            least: (0.0, 1.0),
            times: Times::Clock,
            is_lowest: true,
            empty: panels::PLOT_EMPTY,
            height,
            end: theme::PLOT_END,
            is_sparkline: false,
        }
    }

    /// Draws it as wide as `ui`. A drag pans in time, the wheel zooms, Shift-drag or the right button selects an area to zoom
    /// into, a double click resets everything.
    pub(crate) fn ui(&self, ui: &mut Ui, view: &mut ChartView) -> ChartResponse {
        let mut traces = std::mem::take(&mut view.traces);
        let (from_s, to_s) = view.time.span();
        let width = ui.available_width() - self.end;
        let columns = (width - theme::PLOT_AXIS) * ui.pixels_per_point();
        let columns = columns.clamp(1.0, COLUMNS_MOST);
        let extent = self.fetch(&mut traces, (from_s, to_s), columns);
        let (aim, scale) = self.scale(ui, view, extent);
        ui.spacing_mut().item_spacing.y = 0.0;
        // The background shows the extent of a plot; a frame would be as conspicuous as the curves.
        let frame = std::mem::take(&mut ui.visuals_mut().widgets.noninteractive.bg_stroke);
        if !self.is_sparkline {
            self.caption_ui(ui, view);
        }
        let bounds = PlotBounds::from_min_max([from_s, scale.0], [to_s, scale.1]);
        let pieces = self.curves.iter().flat_map(|curve| curve.pieces(&traces));
        let per_s = f64::from(columns) / (to_s - from_s);
        let (dense, sparse): (Vec<_>, Vec<_>) =
            pieces.partition(|(curve, piece)| curve.is_dense(piece, per_s));
        let is_fixed = view.scales.chosen(self.title).is_some();
        let plot = with_drags(ui, self.plot(is_fixed).width(width));
        let shown = plot.show(ui, |plot| {
            plot.set_plot_bounds(bounds);
            self.items(plot);
            for (curve, piece) in &sparse {
                plot.line(curve.line(piece));
            }
        });
        ui.visuals_mut().widgets.noninteractive.bg_stroke = frame;
        let frame = *shown.transform.frame();
        let mut mesh = Mesh::default();
        for (curve, piece) in &dense {
            let places = curve.places(piece, &shown.transform);
            plot_line::add(&mut mesh, curve.stroke, 1.0 / ui.pixels_per_point(), places);
        }
        ui.painter()
            .with_clip_rect(frame.intersect(ui.clip_rect()))
            .add(mesh);
        if dense.is_empty() && sparse.is_empty() {
            let empty = Label::new(self.look.tr(self.empty), self.look.palette.muted);
            empty.small().center().put(ui, frame);
        }
        view.traces = traces;
        self.pointer_ui(ui, view, frame);
        self.coordinates_ui(ui, &shown.response, &shown.transform);
        let name = self.look.tr(self.title);
        let info = || WidgetInfo::labeled(Role::Image, true, name);
        shown.response.widget_info(info);
        let axis = frame
            .with_max_x(frame.left())
            .with_min_x(frame.left() - theme::PLOT_AXIS);
        let id = shown.response.id.with("values");
        let shown = ChartResponse {
            inner: ui.interact(axis, id, Sense::click_and_drag()),
            response: shown.response,
            transform: shown.transform,
            hovered_plot_item: None,
        };
        if !self.is_sparkline {
            let axis = ScaleAxis {
                title: self.title,
                ends: aim,
                response: &shown.inner,
            };
            view.scales.axis_ui(ui, self.look, &axis);
        }
        view.act(ui, &shown, self.title, bounds);
        shown
    }

    /// Returns the target ends of the scale for values of this extent, and the current ends while it eases towards them.
    fn scale(
        &self,
        ui: &Ui,
        view: &mut ChartView,
        extent: Option<(f64, f64)>,
    ) -> ((f64, f64), (f64, f64)) {
        if let Some(chosen) = view.scales.chosen(self.title) {
            return (chosen, chosen);
        }
        let wanted = scales::rounded(self.least, extent, self.height - self.caption());
        let follows = !view.time.is_held();
        let at_s = follows.then(|| ui.input(|input| input.time));
        let aim = view.scales.settled(self.title, wanted, at_s);
        (aim, scales::eased(ui, self.title, aim))
    }

    const fn caption(&self) -> f32 {
        if self.is_sparkline {
            0.0
        } else {
            theme::PLOT_CAPTION
        }
    }

    /// Draws the pointer's time in another chart: at a fixed position, although time advances.
    fn pointer_ui(&self, ui: &Ui, view: &ChartView, frame: Rect) {
        let other = view.pointed.filter(|(of, _)| *of != self.title.en);
        if let Some((_, part)) = other {
            #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
            let x = frame.left() + frame.width() * part as f32;
            let stroke = Stroke::new(1.0, self.look.palette.faint);
            ui.painter().vline(x, frame.y_range(), stroke);
        }
    }

    /// Draws time and value at the pointer, over the curves.
    fn coordinates_ui(&self, ui: &Ui, response: &Response, transform: &PlotTransform) {
        let frame = *transform.frame();
        let Some(pointer) = response.hover_pos().filter(|at| frame.contains(*at)) else {
            return;
        };
        let (at, bounds) = (transform.value_from_position(pointer), transform.bounds());
        let time = self.times.text(at.x, bounds.width() / 100.0);
        let value = scales::number(at.y, bounds.height() / 100.0);
        let text = format!("{time}  {value}");
        let palette = self.look.palette;
        let width = kit::text_width(ui, &text, theme::number()) + 1.0;
        let size = vec2(width, theme::TEXT_LINE);
        let corner = frame.right_bottom() - size - vec2(theme::STEP, 2.0);
        let place = Rect::from_min_size(corner, size);
        let ground = palette.sunken.gamma_multiply(0.8);
        ui.painter()
            .rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, ground);
        Label::new(&text, palette.text).number().paint(ui, place);
    }

    /// Fetches the points of measured curves. Returns the range of all values.
    fn fetch(
        &self,
        traces: &mut Traces,
        (from_s, to_s): TimeSpan,
        columns: f32,
    ) -> Option<(f64, f64)> {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped before"
        )]
        let columns = columns as usize;
        let levels = self.levels.iter().map(|(level, _)| (*level, *level));
        let mut extent = levels.fold(None, scales::joined);
        for curve in &self.curves {
            let [ahead_s, zero] = curve.zero;
            let (from_s, to_s) = (from_s + ahead_s, to_s + ahead_s);
            match curve.points {
                Points::Own(points) => {
                    let values = points.iter().map(|[_, value]| (value - zero, value - zero));
                    extent = values.fold(extent, scales::joined);
                }
                Points::Measured(history, series) => {
                    let trace = traces.entry((curve.beside, series)).or_default();
                    history.trace(series, from_s, to_s, columns, trace);
                    // A setpoint holds until the next one, although it is read rarely.
                    if curve.steps && history.reading(series, to_s).is_some() {
                        trace.hold_until(to_s);
                    }
                    // A trace keeps every extreme; the point before the left edge is not visible.
                    let seen = trace.points().filter(|[at_s, _]| *at_s >= from_s);
                    let values = seen.map(|[_, value]| (value - zero, value - zero));
                    extent = values.fold(extent, scales::joined);
                }
            }
        }
        extent
    }

    /// Draws title, notes and the values under the pointer; above the curves, never over them.
    fn caption_ui(&self, ui: &mut Ui, view: &ChartView) {
        let look = self.look;
        let place = vec2(ui.available_width(), theme::PLOT_CAPTION);
        let right = Layout::right_to_left(Align::Center);
        ui.allocate_ui_with_layout(place, right, |ui| {
            ui.set_min_height(theme::PLOT_CAPTION);
            ui.add_space(self.end - theme::PLOT_END);
            let (fixed, tip) = (panels::RANGE_FIXED, panels::RANGE.tip());
            let is_fixed = view.scales.chosen(self.title).is_some();
            let taken = if is_fixed {
                kit::text_width(ui, look.tr(fixed), theme::small()) + theme::GAP
            } else {
                0.0
            };
            if let Some(at_s) = view.pointed_s() {
                // A user who points at the chart wants the values: the title is truncated first.
                let room = ui.available_width() - theme::PLOT_AXIS - TITLE_LEAST - taken;
                self.readings_ui(ui, at_s, room);
            }
            kit::left_ui(ui, |ui| {
                ui.add_space(theme::PLOT_AXIS);
                ui.scope(|ui| {
                    ui.set_max_width((ui.available_width() - taken).max(0.0));
                    let title = Label::new(look.tr(self.title), look.palette.muted);
                    title.small().ui(ui);
                });
                if is_fixed {
                    let label = Label::muted(look, fixed);
                    label.small().ui(ui).on_hover_text(look.tr(tip));
                }
            });
        });
    }

    /// Draws the values at a time within this width, each in the colour of its curve.
    fn readings_ui(&self, ui: &mut Ui, at_s: f64, room: f32) {
        let mut job = LayoutJob::default();
        let mut texts = Vec::new();
        for curve in &self.curves {
            let (Points::Measured(history, series), Some(digits)) = (curve.points, curve.decimals)
            else {
                continue;
            };
            let value = history.reading(series, at_s).map(|reading| {
                let value = f64::from(reading.value) - curve.zero[1];
                format!("{value:.digits$}")
            });
            let text = value.unwrap_or_else(|| format::UNKNOWN.to_owned());
            let format = TextFormat::simple(theme::number(), curve.stroke.color);
            job.append(&format!(" {text:>6}"), 0.0, format);
            texts.push(text);
        }
        if texts.is_empty() || room <= 0.0 {
            return;
        }
        job.wrap = TextWrapping::truncate_at_width(room);
        let galley = ui.painter().layout_job(job);
        let response = ui.add(egui::Label::new(galley));
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, texts.join(" ")));
        let look = self.look;
        let name = look.tr_with(self.title, look.tr(panels::UNDER_POINTER));
        kit::set_accessible_name(&response, &name);
    }

    fn plot(&self, is_fixed: bool) -> Plot<'_> {
        let palette = self.look.palette;
        let color = if is_fixed {
            palette.accent
        } else {
            palette.muted
        };
        let hints = |hints: AxisHints<'static>, color: Color32| {
            let hints = hints.tick_label_font(theme::number());
            hints.tick_label_color(color).label_spacing(1.0..=2.0)
        };
        let values = hints(AxisHints::new_y(), color).min_thickness(theme::PLOT_AXIS);
        let is_sparkline = self.is_sparkline;
        let values = values.formatter(move |mark, _| match is_sparkline {
            true => String::new(),
            false => scales::number(mark.value, mark.step_size),
        });
        let times = hints(AxisHints::new_x(), palette.muted).min_thickness(theme::PLOT_TIME_AXIS);
        let own = self.times;
        let times = times.formatter(move |mark, seen| own.label(mark, seen));
        let spacing = move |input: GridInput| {
            if is_sparkline {
                return Vec::new();
            }
            let step = scales::step(input.bounds, input.base_step_size);
            marks(input.bounds, 0.0, step)
        };
        let time_spacing = move |input: GridInput| {
            let step = scales::time_step(input.base_step_size);
            marks(input.bounds, own.zero_s(), step)
        };
        Plot::new(self.title.en)
            .height(self.height - self.caption())
            .min_size(vec2(0.0, 0.0))
            .show_axes([self.is_lowest, true])
            .custom_x_axes(vec![times])
            .custom_y_axes(vec![values])
            .x_grid_spacer(time_spacing)
            .y_grid_spacer(spacing)
            .grid_color(palette.grid)
            .grid_fade(0.0)
            .cursor_color(palette.faint)
            .allow_zoom([true, false])
            .allow_axis_zoom_drag([true, false])
            .allow_scroll(false)
            .allow_double_click_reset(false)
    }

    fn items(&self, plot: &mut PlotUi<'_>) {
        if let Some([a, b]) = self.cursors {
            let accent = self.look.palette.accent;
            let between = egui_plot::Span::new("", a.min(b)..=a.max(b));
            let between = between.fill(accent.gamma_multiply(0.08));
            plot.span(between.border_color(accent));
        }
        for (at_s, color) in &self.moments {
            plot.vline(VLine::new("", *at_s).color(*color));
        }
        for (value, color) in &self.levels {
            let dashed = LineStyle::dashed_dense();
            plot.hline(HLine::new("", *value).color(*color).style(dashed));
        }
    }

    /// Index of the curve nearest to the pointer; of several, the foremost.
    pub(crate) fn nearest(&self, shown: &ChartResponse) -> Option<usize> {
        let at = shown.response.hover_pos()?;
        let apart = |curve: &ChartCurve<'_>| {
            let Points::Own(points) = curve.points else {
                return None;
            };
            let places: Vec<Pos2> = curve.places(points, &shown.transform).collect();
            let pairs = places.iter().zip(places.iter().skip(1));
            pairs
                .map(|(from, to)| distance(*from, *to, at))
                .reduce(f32::min)
        };
        let near = self.curves.iter().enumerate().rev();
        let near = near.filter_map(|(index, curve)| Some((index, apart(curve)?)));
        let near = near.filter(|(_, apart)| *apart <= 9.0);
        near.min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(index, _)| index)
    }
}

/// A drag pans the plot in time; with Shift, or with the right button, it selects an area to zoom into.
fn with_drags<'a>(ui: &Ui, plot: Plot<'a>) -> Plot<'a> {
    let marks = ui.input(|input| input.modifiers.shift);
    let boxes = if marks {
        PointerButton::Primary
    } else {
        PointerButton::Secondary
    };
    plot.allow_drag([!marks, false])
        .boxed_zoom_pointer_button(boxes)
}

/// Distance of the point `at` from a line segment.
fn distance(from: Pos2, to: Pos2, at: Pos2) -> f32 {
    let way = to - from;
    let part = (at - from).dot(way) / way.length_sq().max(f32::MIN_POSITIVE);
    (from + way * part.clamp(0.0, 1.0)).distance(at)
}

impl ChartView {
    /// Advances the time window to `now_s`: never before the start of the history, and `window_s` wide while it follows.
    pub(crate) fn advance(&mut self, history: &History, now_s: f64, window_s: f64) {
        let first_s = history.first_secs().unwrap_or(now_s);
        self.time.advance((first_s.min(now_s), now_s), window_s);
    }

    /// Format of the times: age, or clock time while the chart is held.
    pub(crate) fn times(&self, look: Look) -> Times {
        if self.time.is_held() {
            Times::Clock
        } else {
            Times::From(self.time.span().1, look.tr(panels::NOW))
        }
    }

    /// Time at the pointer in any of the charts, in seconds.
    pub(crate) fn pointed_s(&self) -> Option<f64> {
        let (from_s, to_s) = self.time.span();
        let at_s = |(_, part)| from_s + part * (to_s - from_s);
        self.pointed.map(at_s)
    }

    /// Applies drags handled by `egui_plot`, the wheel, and double clicks.
    fn act(&mut self, ui: &Ui, shown: &ChartResponse, title: Text, asked: PlotBounds) {
        let bounds = shown.transform.bounds();
        if *bounds != asked {
            self.time.show(bounds.range_x().into_inner());
            // A low box selects time only.
            let part = bounds.height() / asked.height();
            if (BOX_LEAST..0.999).contains(&part) {
                let (low, high) = bounds.range_y().into_inner();
                self.scales.choose(title, low, high);
            }
            ui.request_repaint();
        }
        let scroll = ui.input(|input| input.smooth_scroll_delta);
        let pointed = pointed_s(shown);
        if let Some(at_s) = pointed.filter(|_| scroll != vec2(0.0, 0.0)) {
            let by_s = -f64::from(scroll.x) * shown.transform.dvalue_dpos()[0];
            let factor = f64::from(-scroll.y / theme::PLOT_WHEEL).exp2();
            if scroll.x == 0.0 {
                self.time.zoom(at_s, factor)
            } else {
                self.time.pan(by_s)
            }
            ui.request_repaint();
        }
        if pointed.is_some() || self.pointed.is_some_and(|(of, _)| of == title.en) {
            let (from_s, to_s) = bounds.range_x().into_inner();
            let before = self.pointed;
            self.pointed = pointed.map(|at_s| (title.en, (at_s - from_s) / (to_s - from_s)));
            if self.pointed != before {
                // The charts above were drawn before the pointer's time was known.
                ui.request_repaint();
            }
        }
        if shown.response.double_clicked() {
            self.time.follow();
            self.scales.forget(title);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_plot::{PlotGeometry, PlotItem};

    #[test]
    fn a_value_that_was_asked_for_stands_until_the_next() {
        let points = [[0.0, 1.0], [2.0, 5.0]];
        let mut curve = ChartCurve::new(Points::Own(&points), Stroke::new(1.0, Color32::RED));
        curve.steps = true;
        let line = curve.line(&points);
        let PlotGeometry::Points(drawn) = line.geometry() else {
            panic!("a line has points");
        };
        let drawn: Vec<[f64; 2]> = drawn.iter().map(|point| [point.x, point.y]).collect();
        assert_eq!(drawn, [[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]]);
    }

    #[test]
    fn only_more_points_than_columns_are_a_band() {
        let points: Vec<[f64; 2]> = (0..100_u8).map(|n| [f64::from(n), 1.0]).collect();
        let curve = ChartCurve::new(Points::Own(&points), Stroke::new(1.0, Color32::RED));
        assert!(curve.is_dense(&points, 0.5));
        assert!(!curve.is_dense(&points, 2.0));
        let alone = points.get(..1).unwrap_or_default();
        assert!(!curve.is_dense(alone, 0.5));
    }
}
