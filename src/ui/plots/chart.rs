//! The one plot of the program: curves over time in `egui_plot`, with what that lacks. Knows no hand.

use crate::ui::kit::controls::Label;
use crate::ui::kit::dash::Dash;
use crate::ui::kit::look::Look;
use crate::ui::plots::bars;
use crate::ui::plots::scales::{self, Scales};
use crate::ui::plots::time_window::{Span, TimeWindow};
use crate::ui::text::{Text, panels, plots};
use crate::ui::theme;
use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Color32, Layout, Mesh, PointerButton, Pos2, Rect, Response, Role, Sense, Shape, Stroke,
    Ui, WidgetInfo, pos2, vec2,
};
use egui_plot::{
    AxisHints, CoordinatesFormatter, Corner, GridMark, HLine, LineStyle, Plot, PlotBounds,
    PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform, PlotUi, VLine,
};
use std::ops::RangeInclusive;

/// Most columns that a chart is drawn in.
const COLUMNS_MOST: f32 = 8192.0;
/// A marked box that is lower or narrower is not meant in that direction, in points.
const BOX_LEAST: f32 = 12.0;

/// One unbroken line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Curve<'a> {
    /// Seconds and values, oldest first.
    pub(crate) points: &'a [[f64; 2]],
    /// What is taken from each point.
    pub(crate) zero: [f64; 2],
    /// Width and colour.
    pub(crate) stroke: Stroke,
    /// Kind of stroke.
    pub(crate) dash: Dash,
    /// True if a value stands until the next one: nothing was asked for what lies between.
    pub(crate) steps: bool,
}

impl<'a> Curve<'a> {
    /// A plain line.
    pub(crate) const fn new(points: &'a [[f64; 2]], stroke: Stroke) -> Self {
        Self {
            points,
            zero: [0.0, 0.0],
            stroke,
            dash: Dash::Solid,
            steps: false,
        }
    }

    fn places(&self, transform: &PlotTransform) -> impl Iterator<Item = Pos2> {
        let [left, bottom] = transform.bounds().min();
        let [across, up] = transform.dpos_dvalue();
        let (corner, [zero_s, zero]) = (transform.frame().left_bottom(), self.zero);
        self.points.iter().map(move |[at_s, value]| {
            let (x, y) = (
                (at_s - zero_s - left) * across,
                (value - zero - bottom) * up,
            );
            #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
            let way = vec2(x as f32, y as f32);
            corner + way
        })
    }

    fn draw(&self, transform: &PlotTransform, pixel: f32, mesh: &mut Mesh) -> Vec<Shape> {
        let stroke = self.stroke;
        let mut places = self.places(transform);
        let ends = self.points.first().zip(self.points.last());
        let width = ends.map_or(0.0, |(first, last)| last[0] - first[0]);
        let pixels = width * transform.dpos_dvalue_x() / f64::from(pixel);
        let count = u32::try_from(self.points.len()).unwrap_or(u32::MAX);
        if let ([_], Some(alone)) = (self.points, self.places(transform).next()) {
            // A line of one point has no length: what was measured alone is a dot.
            vec![Shape::circle_filled(alone, stroke.width, stroke.color)]
        } else if f64::from(count) > pixels + 2.0 && self.dash == Dash::Solid {
            bars::add(mesh, stroke, pixel, places);
            Vec::new()
        } else if self.steps {
            let mut all: Vec<Pos2> = places.next().into_iter().collect();
            for place in places {
                all.extend(all.last().map(|before| pos2(place.x, before.y)));
                all.push(place);
            }
            self.dash.shapes(all, stroke)
        } else {
            self.dash.shapes(places.collect(), stroke)
        }
    }
}

/// All lines of a chart, as `egui_plot` draws what is not its own.
struct Curves<'a> {
    base: PlotItemBase,
    curves: &'a [Curve<'a>],
}

impl PlotItem for Curves<'_> {
    fn shapes(&self, ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let pixel = 1.0 / ui.pixels_per_point();
        for curve in self.curves {
            let mut mesh = Mesh::default();
            shapes.extend(curve.draw(transform, pixel, &mut mesh));
            if !mesh.is_empty() {
                shapes.push(mesh.into());
            }
        }
    }

    fn initialize(&mut self, _seen: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        Color32::PLACEHOLDER
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::None
    }

    fn bounds(&self) -> PlotBounds {
        PlotBounds::NOTHING
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}

/// How times are told.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Times {
    /// As a clock shows them.
    Clock,
    /// As seconds from a moment, which has a word of its own.
    From(f64, &'static str),
}

/// What charts over one time remember between frames.
#[derive(Debug, Default)]
pub(crate) struct ChartView {
    /// What is shown of the time.
    pub(crate) time: TimeWindow,
    /// Scales that a person chose.
    pub(crate) scales: Scales,
    /// Where a box began that is being marked.
    marked: Option<Pos2>,
}

/// A chart of one quantity.
pub(crate) struct Chart<'a> {
    /// How it looks.
    pub(crate) look: Look,
    /// What it shows, with its unit. Different for each of the charts that share a view.
    pub(crate) title: Text,
    /// The lines, the foremost last.
    pub(crate) curves: Vec<Curve<'a>>,
    /// Values to compare with, dashed.
    pub(crate) levels: Vec<(f64, Color32)>,
    /// Moments in seconds, as lines across.
    pub(crate) moments: Vec<(f64, Color32)>,
    /// Seconds of two cursors.
    pub(crate) cursors: Option<[f64; 2]>,
    /// The scale, unless a person chose another one.
    pub(crate) scale: (f64, f64),
    /// How times are told; nothing below the chart if `None`.
    pub(crate) times: Option<Times>,
    /// Values under the pointer, in the colours of their lines.
    pub(crate) readings: Vec<(Color32, String)>,
    /// True if a column of pixels stands for several measurements.
    pub(crate) is_decimated: bool,
    /// Said where there is no line.
    pub(crate) empty: Text,
    /// With caption and axis of time.
    pub(crate) height: f32,
}

/// What was drawn, and what the pointer does there.
pub(crate) struct ChartResponse {
    /// Of the curves' ground.
    pub(crate) ground: Response,
    /// Of the numbers beside it.
    pub(crate) axis: Response,
    /// Between screen and values.
    pub(crate) transform: PlotTransform,
}

impl ChartResponse {
    /// The time that the pointer is at.
    pub(crate) fn pointed_s(&self) -> Option<f64> {
        let at = self.ground.hover_pos()?;
        Some(self.transform.value_from_position(at).x)
    }
}

/// Columns of pixels that a chart would have here.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a width in pixels, clamped"
)]
pub(crate) fn columns(ui: &Ui) -> usize {
    let width = (ui.available_width() - theme::PLOT_AXIS) * ui.pixels_per_point();
    width.clamp(1.0, COLUMNS_MOST) as usize
}

impl<'a> Chart<'a> {
    /// Without anything in it.
    pub(crate) const fn new(look: Look, height: f32) -> Self {
        Self {
            look,
            title: panels::HISTORY,
            curves: Vec::new(),
            levels: Vec::new(),
            moments: Vec::new(),
            cursors: None,
            scale: (0.0, 1.0),
            times: None,
            readings: Vec::new(),
            is_decimated: false,
            empty: panels::PLOT_EMPTY,
            height,
        }
    }

    /// Draws it as wide as `ui`. A drag moves in time, the wheel zooms, shift or the right button marks what to zoom
    /// into, a double click takes all of it back.
    pub(crate) fn ui(&self, ui: &mut Ui, view: &mut ChartView) -> ChartResponse {
        let (from, to) = view.time.span();
        let chosen = view.scales.chosen(self.title);
        let scale = chosen.unwrap_or(self.scale);
        ui.spacing_mut().item_spacing.y = 0.0;
        self.caption_ui(ui, chosen.is_some());
        let bounds = PlotBounds::from_min_max([from, scale.0], [to, scale.1]);
        let marks = view.marked.is_some() || ui.input(|input| input.modifiers.shift);
        let plot = self.plot(chosen.is_some());
        let shown = plot.allow_drag([!marks, false]).show(ui, |plot| {
            plot.set_plot_bounds(bounds);
            self.items(plot);
        });
        let name = self.look.say(self.title);
        let info = || WidgetInfo::labeled(Role::Image, true, name);
        shown.response.widget_info(info);
        let frame = *shown.transform.frame();
        let axis = frame
            .with_max_x(frame.left())
            .with_min_x(frame.left() - theme::PLOT_AXIS);
        let id = shown.response.id.with("values");
        let shown = ChartResponse {
            axis: ui.interact(axis, id, Sense::DRAG),
            ground: shown.response,
            transform: shown.transform,
        };
        view.scales.act(ui, &shown.axis, self.title, scale);
        view.act(ui, &shown, self, (from, to));
        if self.curves.is_empty() {
            let empty = Label::new(self.look.say(self.empty), self.look.palette.muted);
            empty.small().center().put(ui, frame);
        }
        shown
    }

    /// Title, what is to be known of it, and the values under the pointer; over the curves, never on them.
    fn caption_ui(&self, ui: &mut Ui, is_fixed: bool) {
        let look = self.look;
        let place = vec2(ui.available_width(), theme::PLOT_CAPTION);
        let right = Layout::right_to_left(Align::Center);
        ui.allocate_ui_with_layout(place, right, |ui| {
            ui.set_min_height(theme::PLOT_CAPTION);
            if !self.readings.is_empty() {
                self.readings_ui(ui);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add_space(theme::PLOT_AXIS);
                Label::new(look.say(self.title), look.palette.muted)
                    .small()
                    .ui(ui);
                let words = [
                    (is_fixed, plots::RANGE_FIXED, plots::RANGE_TIP),
                    (self.is_decimated, plots::DECIMATED, plots::DECIMATED_TIP),
                ];
                for (_, text, tip) in words.into_iter().filter(|(said, ..)| *said) {
                    let label = Label::new(look.say(text), look.palette.muted);
                    label
                        .font(theme::tiny())
                        .ui(ui)
                        .on_hover_text(look.say(tip));
                }
            });
        });
    }

    fn readings_ui(&self, ui: &mut Ui) {
        let mut job = LayoutJob::default();
        for (color, text) in &self.readings {
            let format = TextFormat::simple(theme::number_small(), *color);
            job.append(&format!(" {text:>6}"), 0.0, format);
        }
        let response = ui.add(egui::Label::new(job).truncate());
        let texts: Vec<&str> = self
            .readings
            .iter()
            .map(|(_, text)| text.as_str())
            .collect();
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, texts.join(" ")));
        let look = self.look;
        let name = format!(
            "{} {}",
            look.say(self.title),
            look.say(plots::UNDER_POINTER)
        );
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_label(name));
    }

    fn plot(&self, is_fixed: bool) -> Plot<'_> {
        let palette = self.look.palette;
        let color = match is_fixed {
            true => palette.accent,
            false => palette.muted,
        };
        let hints = |hints: AxisHints<'static>, color: Color32| {
            let hints = hints.tick_label_font(theme::number_small());
            hints.tick_label_color(color).label_spacing(1.0..=2.0)
        };
        let values = hints(AxisHints::new_y(), color).min_thickness(theme::PLOT_AXIS);
        let values = values.formatter(|mark, _| scales::number(mark.value, mark.step_size));
        let times = hints(AxisHints::new_x(), palette.muted).min_thickness(theme::PLOT_TIME_AXIS);
        let own = self.times.unwrap_or(Times::Clock);
        let times = times.formatter(move |mark, seen| own.label(mark, seen));
        let pointed = move |at: &PlotPoint, bounds: &PlotBounds| {
            let text = own.text(at.x, bounds.width() / 100.0);
            format!("{text}  {}", scales::number(at.y, bounds.height() / 100.0))
        };
        let spacing = |input: egui_plot::GridInput| {
            let step = scales::step(input.bounds, input.base_step_size);
            marks(input.bounds, 0.0, step)
        };
        let time_spacing = move |input: egui_plot::GridInput| {
            let step = scales::time_step(input.base_step_size);
            marks(input.bounds, own.zero_s(), step)
        };
        Plot::new(self.title.en)
            .height(self.height - theme::PLOT_CAPTION)
            .min_size(egui::Vec2::ZERO)
            .show_axes([self.times.is_some(), true])
            .custom_x_axes(vec![times])
            .custom_y_axes(vec![values])
            .x_grid_spacer(time_spacing)
            .y_grid_spacer(spacing)
            .grid_color(palette.grid)
            .grid_fade(0.0)
            .cursor_color(palette.faint)
            .link_cursor(egui::Id::unique("charts"), [true, false])
            .coordinates_formatter(Corner::RightBottom, CoordinatesFormatter::new(pointed))
            .allow_zoom([true, false])
            .allow_axis_zoom_drag([true, false])
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_double_click_reset(false)
    }

    fn items<'b>(&'b self, plot: &mut PlotUi<'b>) {
        if let Some([a, b]) = self.cursors {
            let accent = self.look.palette.accent;
            let between = egui_plot::Span::new("", a.min(b)..=a.max(b));
            plot.span(
                between
                    .fill(accent.gamma_multiply(0.08))
                    .border_color(accent),
            );
        }
        for (at_s, color) in &self.moments {
            plot.vline(VLine::new("", *at_s).color(*color));
        }
        for (value, color) in &self.levels {
            let dashed = LineStyle::dashed_dense();
            plot.hline(HLine::new("", *value).color(*color).style(dashed));
        }
        plot.add(Curves {
            base: PlotItemBase::new(String::new()),
            curves: &self.curves,
        });
    }

    /// The line that passes next to the pointer, by its place in the list; of several the foremost.
    pub(crate) fn nearest(&self, shown: &ChartResponse) -> Option<usize> {
        let at = shown.ground.hover_pos()?;
        let apart = |curve: &Curve<'_>| {
            let places: Vec<Pos2> = curve.places(&shown.transform).collect();
            let pairs = places.iter().zip(places.iter().skip(1));
            pairs
                .map(|(from, to)| distance(*from, *to, at))
                .reduce(f32::min)
        };
        let near = self.curves.iter().enumerate().rev();
        let near = near.filter_map(|(index, curve)| Some((index, apart(curve)?)));
        let near = near.filter(|(_, apart)| *apart <= theme::LINE_NEAR);
        near.min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(index, _)| index)
    }
}

/// From a place to a piece of a line.
fn distance(from: Pos2, to: Pos2, at: Pos2) -> f32 {
    let way = to - from;
    let part = (at - from).dot(way) / way.length_sq().max(f32::MIN_POSITIVE);
    (from + way * part.clamp(0.0, 1.0)).distance(at)
}

impl ChartView {
    fn act(&mut self, ui: &Ui, shown: &ChartResponse, chart: &Chart<'_>, span: Span) {
        let bounds = shown.transform.bounds();
        let moved = (bounds.min()[0], bounds.max()[0]);
        if moved != span {
            self.time.show(moved);
            ui.request_repaint();
        }
        let scroll = ui.input(|input| input.smooth_scroll_delta);
        if let Some(at_s) = shown.pointed_s().filter(|_| scroll != egui::Vec2::ZERO) {
            if scroll.x != 0.0 {
                self.time
                    .pan(-f64::from(scroll.x) / shown.transform.dpos_dvalue_x());
            } else {
                self.time
                    .zoom(at_s, f64::from(-scroll.y / theme::PLOT_WHEEL).exp2());
            }
            ui.request_repaint();
        }
        self.mark(ui, shown, chart);
        if shown.ground.double_clicked() {
            self.time.follow();
            self.scales.forget(chart.title);
        }
    }

    /// The box that is being marked. One that is low spans all values, so that time alone can be marked.
    fn mark(&mut self, ui: &Ui, shown: &ChartResponse, chart: &Chart<'_>) {
        let ground = &shown.ground;
        let (shift, pressed_at) =
            ui.input(|input| (input.modifiers.shift, input.pointer.press_origin()));
        if ground.drag_started() && (shift || ground.dragged_by(PointerButton::Secondary)) {
            self.marked = pressed_at;
        }
        let ends = self.marked.zip(ground.interact_pointer_pos());
        let Some((from, to)) = ends.filter(|_| ground.dragged() || ground.drag_stopped()) else {
            return;
        };
        let frame = *shown.transform.frame();
        let mut marked = Rect::from_two_pos(from, to).intersect(frame);
        let is_high = marked.height() >= BOX_LEAST;
        if !is_high {
            marked = Rect::from_x_y_ranges(marked.x_range(), frame.y_range());
        }
        if ground.dragged() {
            let accent = chart.look.palette.accent;
            ui.painter()
                .rect_filled(marked, 0.0, accent.gamma_multiply(0.25));
            return;
        }
        self.marked = None;
        let low = shown.transform.value_from_position(marked.left_bottom());
        let high = shown.transform.value_from_position(marked.right_top());
        if marked.width() >= BOX_LEAST {
            self.time.show((low.x, high.x));
            if is_high {
                self.scales.choose(chart.title, low.y, high.y);
            }
        }
    }
}

/// Lines of a grid, a step apart, one of them at `zero`.
fn marks((from, to): (f64, f64), zero: f64, step: f64) -> Vec<GridMark> {
    let first = ((from - zero) / step).ceil();
    // No step gives more; the bound guards against a broken one.
    let marks = (0..64_u8).map(|n| GridMark {
        value: zero + (first + f64::from(n)) * step,
        step_size: step,
    });
    marks
        .take_while(|mark| mark.value <= to + step * 1e-6)
        .collect()
}

impl Times {
    const fn zero_s(self) -> f64 {
        match self {
            Self::Clock => 0.0,
            Self::From(at_s, _) => at_s,
        }
    }

    fn label(self, mark: GridMark, seen: &RangeInclusive<f64>) -> String {
        // At the left edge it would run into the numbers of the values.
        let is_left = mark.value - seen.start() < (seen.end() - seen.start()) * 0.04;
        match self {
            _ if is_left => String::new(),
            Self::From(at_s, word) if (mark.value - at_s).abs() < mark.step_size * 1e-3 => {
                word.into()
            }
            _ => self.text(mark.value, mark.step_size),
        }
    }

    /// A time, fine enough for steps of `step_s`.
    fn text(self, at_s: f64, step_s: f64) -> String {
        let digits = scales::digits(step_s);
        match self {
            Self::Clock => clock(at_s, step_s),
            Self::From(zero_s, _) if step_s >= 60.0 => {
                format!("{:+.0} min", (at_s - zero_s) / 60.0)
            }
            Self::From(zero_s, _) => format!("{:+.digits$} s", at_s - zero_s),
        }
    }
}

/// A time of the program as a clock shows it, fine enough for steps of `step_s`.
pub(crate) fn clock(at_s: f64, step_s: f64) -> String {
    let digits = scales::digits(step_s);
    let unit = [1.0, 10.0, 100.0, 1000.0]
        .get(digits)
        .copied()
        .unwrap_or(1.0);
    // Rounded as a whole, so that 59.999 does not become 0:60.
    let at_s = (at_s.max(0.0) * unit).round() / unit;
    let (hours, minutes) = ((at_s / 3600.0).floor(), (at_s / 60.0).floor() % 60.0);
    let seconds = at_s % 60.0;
    let width = if digits == 0 { 2 } else { digits + 3 };
    if hours > 0.0 {
        format!("{hours:.0}:{minutes:02.0}:{seconds:0width$.digits$}")
    } else {
        format!("{minutes:.0}:{seconds:0width$.digits$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_is_as_fine_as_it_needs_to_be() {
        for (at_s, step_s, text) in [
            (5.25, 0.05, "0:05.25"),
            (59.999, 0.01, "1:00.00"),
            (3_725.0, 60.0, "1:02:05"),
            (65.1234, 0.005, "1:05.123"),
            (-1.0, 1.0, "0:00"),
        ] {
            assert_eq!(clock(at_s, step_s), text);
        }
    }

    #[test]
    fn times_are_told_from_their_zero_and_not_at_the_left_edge() {
        let times = Times::From(100.0, "now");
        let label = |value, step_size| times.label(GridMark { value, step_size }, &(90.0..=100.0));
        assert_eq!(label(100.0, 2.0), "now");
        assert_eq!(label(98.0, 2.0), "-2 s");
        assert_eq!(label(90.1, 2.0), "");
        assert_eq!(times.text(-500.0, 60.0), "-10 min");
        assert_eq!(times.text(100.25, 0.05), "+0.25 s");
    }

    #[test]
    fn a_value_that_was_asked_for_stands_until_the_next() {
        let frame = Rect::from_min_size(Pos2::ZERO, vec2(100.0, 100.0));
        let bounds = PlotBounds::from_min_max([0.0, 0.0], [10.0, 10.0]);
        let transform = PlotTransform::new(frame, bounds, false);
        let mut curve = Curve::new(&[[0.0, 1.0], [2.0, 5.0]], Stroke::new(1.0, Color32::RED));
        curve.steps = true;
        let shapes = curve.draw(&transform, 1.0, &mut Mesh::default());
        let [Shape::Path(path)] = shapes.as_slice() else {
            panic!("{shapes:?}");
        };
        let places = [pos2(0.0, 90.0), pos2(20.0, 90.0), pos2(20.0, 50.0)];
        assert_eq!(path.points, places);
    }
}
