//! The stacked plots over one time axis. Asks the history for as many columns as there are pixels.

use crate::app::history::{Mark, MarkKind, Series, Trace};
use crate::hand::PerDof;
use crate::ui::controls::{self, Label};
use crate::ui::look::Pane;
use crate::ui::plot_axes::{self, Band, Extent, TimeAxis};
use crate::ui::plot_bars;
use crate::ui::plot_cursors::Cursors;
use crate::ui::plot_head;
use crate::ui::plot_panels::{PANELS, Panel, PlotLine};
use crate::ui::plot_reach::{self, Reach};
use crate::ui::plot_sight::{Sight, Span};
use crate::ui::text::{Text, panels, plots};
use crate::ui::theme;
use egui::{Align2, Color32, CornerRadius, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Room for the numbers of the vertical axis.
pub(crate) const AXIS: f32 = 40.0;
/// Room for the numbers of the time axis.
pub(crate) const TIME_AXIS: f32 = 20.0;
/// Room for a plot's title.
const CAPTION: f32 = 18.0;
/// Height that a number on the vertical axis needs.
const NUMBER: f32 = 22.0;
/// A plot less high than this says nothing: while figures are read, only the one they are of is shown then.
const LEAST_HEIGHT: f32 = 62.0;
/// Characters of a note beside its line; the rest is in the tooltip.
const NOTE_SHOWN: usize = 24;

/// What the plots need between frames.
#[derive(Debug, Default)]
pub(crate) struct PlotView {
    /// Joints whose curves are hidden.
    pub(crate) hidden: PerDof<bool>,
    /// Whether thresholds are shown.
    pub(crate) thresholds: bool,
    /// Which stretch of time is shown.
    pub(crate) sight: Sight,
    /// The two cursors.
    pub(crate) cursors: Cursors,
    /// Number of the plot whose figures are told.
    pub(crate) chosen: usize,
    /// True while the plots fill the view.
    pub(crate) large: bool,
    /// True if a note was asked for in this frame.
    pub(crate) note_asked: bool,
    /// Width and height of the card in points, for a picture of it.
    pub(crate) size: (u32, u32),
    /// Rows that were copied last, while the menu is open.
    pub(crate) copied: Option<usize>,
    /// The stretch that is being marked to zoom into.
    pub(crate) reach: Reach,
    /// The points of one curve as the history gives them, reused from curve to curve.
    trace: Trace,
    /// The points of one plot, reused from plot to plot.
    curves: Curves,
}

/// How points are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// By the straight way.
    Slopes,
    /// A value stands until the next one: nothing asked a hand for what lies between.
    Steps,
    /// There are more points than pixels.
    Bars,
}

fn steps(points: &[[f64; 2]], out: &mut Vec<[f64; 2]>) {
    let mut before: Option<f64> = None;
    for [time_s, value] in points {
        out.extend(before.map(|before| [*time_s, before]));
        out.push([*time_s, *value]);
        before = Some(*value);
    }
}

/// One unbroken line.
#[derive(Debug)]
struct Curve {
    stroke: Stroke,
    form: Form,
    points: Vec<[f64; 2]>,
}

/// Curves with their strokes, and what they span. Keeps its memory from plot to plot.
#[derive(Debug, Default)]
struct Curves {
    used: usize,
    pool: Vec<Curve>,
    extent: Extent,
    decimated: bool,
}

impl Curves {
    fn clear(&mut self) {
        self.used = 0;
        self.extent = Extent::default();
        self.decimated = false;
    }

    fn push(&mut self, stroke: Stroke, points: &[[f64; 2]], form: Form) {
        if self.used == self.pool.len() {
            self.pool.push(Curve {
                stroke,
                form,
                points: Vec::new(),
            });
        }
        if let Some(curve) = self.pool.get_mut(self.used) {
            (curve.stroke, curve.form) = (stroke, form);
            curve.points.clear();
            match form {
                Form::Steps => steps(points, &mut curve.points),
                Form::Slopes | Form::Bars => curve.points.extend_from_slice(points),
            }
            self.used += 1;
        }
        for [_, value] in points {
            self.extent.include(*value);
        }
    }

    fn iter(&self) -> impl Iterator<Item = &Curve> {
        self.pool.iter().take(self.used)
    }
}

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let now = pane.state.now.secs();
        let first = pane.state.history.first_secs().unwrap_or(now);
        let window = pane.state.settings.plot_window.seconds();
        self.size = (pixels(rect.width()), pixels(rect.height()));
        self.sight.advance((first.min(now), now), window);
        let (head, mut body) = controls::titled_card(ui, look, rect, look.say(panels::HISTORY));
        plot_head::head_ui(ui, head, pane, self);
        plot_head::legend_ui(ui, &mut body, pane, self);
        let shown: Vec<&Panel> = PANELS
            .iter()
            .filter(|panel| pane.state.settings.plots.shows(panel.kind))
            .collect();
        self.chosen = self.chosen.min(shown.len().saturating_sub(1));
        let Some(chosen) = shown.get(self.chosen).copied() else {
            return;
        };
        let measured = chosen.measured(&self.hidden);
        let table_height = self.cursors.table_height(measured.len());
        let (stack, table) = body.split_top_bottom_at_y(body.bottom() - table_height);
        let room = |count: usize| {
            (stack.height() - TIME_AXIS) / f32::from(u8::try_from(count).unwrap_or(u8::MAX).max(1))
        };
        let alone = table_height > 0.0 && room(shown.len()) < LEAST_HEIGHT;
        let shown = if alone { vec![chosen] } else { shown };
        self.stack_ui(ui, stack, pane, &shown, room(shown.len()));
        let table = table.with_min_y(table.top() + theme::GAP);
        if self.cursors.table_ui(ui, table, pane, chosen, &measured) {
            self.chosen = (self.chosen + 1) % pane.state.settings.plots.count().max(1);
        }
    }

    fn stack_ui(
        &mut self,
        ui: &mut Ui,
        stack: Rect,
        pane: &Pane<'_>,
        shown: &[&Panel],
        height: f32,
    ) {
        let look = pane.look;
        let ground = Rect::from_min_max(
            pos2(stack.left() + AXIS, stack.top()),
            pos2(stack.right(), stack.bottom() - TIME_AXIS),
        );
        let axis = Rect::from_min_max(ground.left_bottom(), stack.right_bottom());
        let response = ui.interact(
            ground,
            egui::Id::unique("plots over time"),
            Sense::click_and_drag(),
        );
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(plots::AREA)));
        self.reach.act(ui, &response, ground, &mut self.sight);
        if let Some(at) = response
            .interact_pointer_pos()
            .filter(|_| response.clicked())
        {
            self.choose(at.y - ground.top(), height, shown, pane);
        }
        let span = self.sight.span();
        let pointer = ui
            .ctx()
            .pointer_hover_pos()
            .filter(|at| ground.contains(*at) && response.contains_pointer());
        let pointer_s = pointer.map(|at| plot_axes::time_of(ground, span, at.x));
        let time_axis = TimeAxis {
            span,
            now: (!self.sight.is_held()).then_some(span.1),
        };
        let mut top = stack.top();
        for (n, panel) in shown.iter().enumerate() {
            let place = Rect::from_min_size(pos2(stack.left(), top), vec2(stack.width(), height));
            let plot_rect = self.panel_ui(ui, place, pane, panel, time_axis, pointer_s);
            if n == 0 {
                mark_labels(ui, plot_rect, pane, span);
            }
            top += height;
        }
        plot_axes::time_axis_ui(ui, axis, look, time_axis);
        self.cursors.ui(ui, ground, axis, look, span);
        self.reach.ui(ui, ground, look);
        if let Some(at) = pointer {
            plot_reach::pointer_ui(ui, ground, at, look, time_axis);
        }
        let marks = pointer.map(|at| marks_near(pane, ground, span, at.x));
        match marks.filter(|marks| !marks.is_empty()) {
            Some(marks) => response.on_hover_text_at_pointer(marks),
            None => response,
        };
    }

    /// Takes the plot at this height for the one whose figures are told.
    fn choose(&mut self, y: f32, height: f32, shown: &[&Panel], pane: &Pane<'_>) {
        let plots = &pane.state.settings.plots;
        let mut below = y;
        let hit = shown.iter().find(|_| {
            below -= height;
            below < 0.0
        });
        if let Some(hit) = hit {
            let mut all = PANELS.iter().filter(|panel| plots.shows(panel.kind));
            let number = all.position(|panel| panel.kind == hit.kind);
            self.chosen = number.unwrap_or(self.chosen);
        }
    }

    /// One plot; where its curves are.
    fn panel_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        time: TimeAxis,
        pointer_s: Option<f64>,
    ) -> Rect {
        let look = pane.look;
        let (caption, ground) = rect.split_top_bottom_at_y(rect.top() + CAPTION);
        let ground = ground.with_max_y(ground.bottom() - 2.0);
        let plot_rect = ground.with_min_x(ground.left() + AXIS);
        let lines = panel.lines(&self.hidden);
        self.gather(pane, &lines, time.span, plot_rect.width());
        self.caption_ui(ui, caption, pane, panel, pointer_s);
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
        plot_axes::grid(ui, plot_rect, look, &band, time);
        self.curves_ui(ui, plot_rect, pane, panel, time.span, &band);
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
        plot_rect
    }

    /// Title, whether it is decimated, and the values under the pointer; over the curves, never on them.
    fn caption_ui(
        &self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        pointer_s: Option<f64>,
    ) {
        let look = pane.look;
        let title = look.say(panel.title);
        if let Some(at_s) = pointer_s {
            let lines = panel.measured(&self.hidden);
            rect = plot_reach::readings_ui(ui, rect, pane, panel, &lines, at_s);
        }
        let width = controls::text_width(ui, title, theme::small()) + 1.0;
        let (place, rest) = rect.split_left_right_at_x(rect.left() + width.min(rect.width()));
        Label::new(title, look.palette.muted).small().put(ui, place);
        let text = look.say(plots::DECIMATED);
        let width = controls::text_width(ui, text, theme::tiny()) + 1.0;
        let rest = rest.with_min_x(rest.left() + theme::GAP);
        if self.curves.decimated && width <= rest.width() {
            Label::new(text, look.palette.faint)
                .font(theme::tiny())
                .put(ui, rest.with_max_x(rest.left() + width))
                .on_hover_text(look.say(plots::DECIMATED_TIP));
        }
    }

    fn shows_thresholds(&self, panel: &Panel) -> bool {
        use crate::app::settings::PlotKind;
        self.thresholds && panel.kind == PlotKind::Force
    }

    /// Fetches the curves of one plot, with as many points as the plot is wide.
    fn gather(&mut self, pane: &Pane<'_>, lines: &[PlotLine], span: Span, width: f32) {
        let columns = usize::try_from(pixels(width)).unwrap_or(1);
        self.curves.clear();
        for line in lines {
            pane.state
                .history
                .trace(line.series, span.0, span.1, columns, &mut self.trace);
            let color = pane.look.palette.dof[line.dof];
            let (stroke, form) = if line.wished {
                (Stroke::new(1.0, color.gamma_multiply(0.45)), Form::Steps)
            } else {
                (Stroke::new(theme::LINE, color), Form::Slopes)
            };
            let form = if self.trace.decimated {
                Form::Bars
            } else {
                form
            };
            self.curves.decimated |= self.trace.decimated && !line.wished;
            for segment in &self.trace.segments {
                self.curves.push(stroke, segment, form);
            }
        }
    }

    fn curves_ui(
        &self,
        ui: &Ui,
        rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        span: Span,
        band: &Band,
    ) {
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        for mark in pane.state.history.marks(span.0, span.1) {
            let (_, color) = mark_look(pane, &mark.kind);
            let x = plot_axes::x_of(rect, span, mark.at.secs());
            painter.vline(x, rect.y_range(), Stroke::new(1.0, color));
        }
        if self.shows_thresholds(panel) {
            for (dof, joint) in pane
                .state
                .joints
                .iter()
                .filter(|(dof, _)| !self.hidden[*dof])
            {
                let color = pane.look.palette.dof[dof].gamma_multiply(0.7);
                let y = plot_axes::y_of(rect, band, f64::from(joint.force.get()));
                let ends = [pos2(rect.left(), y), pos2(rect.right(), y)];
                let stroke = Stroke::new(1.0, color);
                painter.extend(egui::Shape::dashed_line(&ends, stroke, 5.0, 4.0));
            }
        }
        let mut mesh = egui::Mesh::default();
        for curve in self.curves.iter() {
            let place = |[time_s, value]: &[f64; 2]| {
                pos2(
                    plot_axes::x_of(rect, span, *time_s),
                    plot_axes::y_of(rect, band, *value),
                )
            };
            let places = curve.points.iter().map(place);
            match (curve.form, curve.points.as_slice()) {
                // A line of one point has no length: what was measured alone is a dot.
                (_, [alone]) => {
                    painter.circle_filled(place(alone), curve.stroke.width, curve.stroke.color);
                }
                (Form::Bars, _) => plot_bars::add(&mut mesh, curve.stroke, places),
                (Form::Slopes | Form::Steps, _) => {
                    painter.line(places.collect(), curve.stroke);
                }
            }
        }
        painter.add(mesh);
    }

    /// The lines of all shown plots and joints: what is copied and saved.
    pub(crate) fn shown_series(&self, pane: &Pane<'_>) -> Vec<Series> {
        let plots = &pane.state.settings.plots;
        let panels = PANELS.iter().filter(|panel| plots.shows(panel.kind));
        let lines = panels.flat_map(|panel| panel.lines(&self.hidden));
        lines.map(|line| line.series).collect()
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

/// A length on the screen as a whole number, at least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a length in pixels, clamped"
)]
fn pixels(length: f32) -> u32 {
    length.clamp(1.0, 8192.0) as u32
}

/// The words of the marks, once, in the topmost plot. Words that would overlap are left out.
fn mark_labels(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, span: Span) {
    let mut free_from = rect.left();
    for mark in pane.state.history.marks(span.0, span.1) {
        let (_, color) = mark_look(pane, &mark.kind);
        let text: String = mark_text(pane, mark).chars().take(NOTE_SHOWN).collect();
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
        let (font, align) = (theme::small(), Align2::LEFT_CENTER);
        controls::paint_text(ui, place, align, &text, font, color);
        free_from = left + width + theme::GAP;
    }
}

fn mark_text(pane: &Pane<'_>, mark: &Mark) -> String {
    let text = pane.look.say(mark_look(pane, &mark.kind).0);
    match &mark.kind {
        MarkKind::Gesture(number) => format!("{text} {number}"),
        MarkKind::Note(words) => words.to_string(),
        _ => text.to_owned(),
    }
}

/// What happened where the pointer is, a line each.
fn marks_near(pane: &Pane<'_>, ground: Rect, span: Span, x: f32) -> String {
    /// A line is easily missed by some pixels.
    const NEAR: f32 = 4.0;
    let (from, to) = (
        plot_axes::time_of(ground, span, x - NEAR),
        plot_axes::time_of(ground, span, x + NEAR),
    );
    let lines = pane.state.history.marks(from, to).map(|mark| {
        let at = plot_axes::clock(mark.at.secs(), span.1 - span.0);
        format!("{at}  {}", mark_text(pane, mark))
    });
    lines.collect::<Vec<_>>().join("\n")
}
