//! The stacked plots over one time axis: where each stands, and what the pointer does in them. Fetches no line.
pub(crate) mod axes;
pub(crate) mod bars;
pub(crate) mod cursors;
pub(crate) mod ends;
pub(crate) mod head;
pub(crate) mod lines;
pub(crate) mod marks;
pub(crate) mod plot_rows;
pub(crate) mod range;
pub(crate) mod reach;
pub(crate) mod sight;
pub(crate) mod state;

pub(crate) use crate::ui::plots::state::PlotView;

use crate::app::settings::PlotKind;
use crate::history::Series;
use crate::ui::kit::controls;
use crate::ui::kit::controls::Label;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::axes::{Band, Placing, TimeAxis};
use crate::ui::plots::ends as plot_ends;
use crate::ui::plots::head as plot_head;
use crate::ui::plots::lines::PlotLines;
use crate::ui::plots::marks as plot_marks;
use crate::ui::plots::plot_rows::{PANELS, Panel};
use crate::ui::plots::reach as plot_reach;
use crate::ui::text::{panels, plots};
use crate::ui::theme;
use egui::{CornerRadius, Painter, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Most columns that a plot is drawn in.
pub(crate) const COLUMNS_PX: f32 = 8192.0;

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let now = pane.state.now.secs();
        let first = pane.state.hand().history.first_secs().unwrap_or(now);
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
            (stack.height() - theme::PLOT_TIME_AXIS)
                / f32::from(u8::try_from(count).unwrap_or(u8::MAX).max(1))
        };
        let alone = table_height > 0.0 && room(shown.len()) < theme::PLOT_LEAST;
        let shown = if alone { vec![chosen] } else { shown };
        // In a window that was forced to be tiny there is no place to draw in.
        let fits = room(shown.len()) > theme::PLOT_CAPTION + 2.0 * theme::PLOT_NUMBER
            && stack.width() > 4.0 * theme::PLOT_AXIS;
        if fits {
            self.stack_ui(ui, stack, pane, &shown, room(shown.len()));
        }
        let table = table.with_min_y(table.top() + theme::GAP);
        if self.cursors.table_ui(ui, table, pane, chosen, &measured) {
            self.chosen = (self.chosen + 1) % pane.state.settings.plots.count().max(1);
        }
    }

    fn stack_ui(
        &mut self,
        ui: &mut Ui,
        stack: Rect,
        pane: &mut Pane<'_>,
        shown: &[&Panel],
        height: f32,
    ) {
        let look = pane.look;
        let ground = Rect::from_min_max(
            pos2(stack.left() + theme::PLOT_AXIS, stack.top()),
            pos2(
                stack.right() - theme::PLOT_ENDS,
                stack.bottom() - theme::PLOT_TIME_AXIS,
            ),
        );
        let axis = ground
            .with_min_y(ground.bottom())
            .with_max_y(stack.bottom());
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
                plot_marks::words_ui(ui, plot_rect, pane, span);
            }
            top += height;
        }
        plot_axes::time_axis_ui(ui, axis, look, time_axis);
        self.cursors.ui(ui, ground, axis, look, span);
        self.reach.ui(ui, ground, look);
        if let Some(at) = pointer {
            plot_reach::pointer_ui(ui, ground, at, look, time_axis);
        }
        let marks = pointer.map(|at| plot_marks::near(pane, ground, span, at.x));
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
        pane: &mut Pane<'_>,
        panel: &Panel,
        time: TimeAxis,
        pointer_s: Option<f64>,
    ) -> Rect {
        let look = pane.look;
        let (caption, ground) = rect.split_top_bottom_at_y(rect.top() + theme::PLOT_CAPTION);
        let ground = ground.with_max_y(ground.bottom() - 2.0);
        let plot_rect = ground
            .with_min_x(ground.left() + theme::PLOT_AXIS)
            .with_max_x(ground.right() - theme::PLOT_ENDS);
        let history = &pane.state.hand().history;
        let columns = usize::try_from(pixels(plot_rect.width())).unwrap_or(1);
        let mut lines = self.lines.remove(&panel.kind).unwrap_or_default();
        lines.gather(history, &panel.lines(&self.hidden), time.span, columns);
        let caption = caption.with_min_x(plot_rect.left());
        self.caption_ui(ui, caption, pane, panel, &lines, pointer_s);
        let mut band = Band::of(panel.row.least_scale, &lines.extent);
        if self.shows_thresholds(panel) {
            for (_, joint) in pane.state.hand().joints.iter() {
                band.include(f64::from(joint.force.get()));
            }
        }
        let room = plot_rect.height() / theme::PLOT_NUMBER;
        let band = self.ranges.band(panel, band, room);
        let axis = ground.with_max_x(plot_rect.left());
        self.ranges.axis_ui(ui, axis, pane, panel, band);
        let round = CornerRadius::same(theme::ROUND_TRACK);
        ui.painter()
            .rect_filled(plot_rect, round, look.palette.sunken);
        plot_axes::grid(ui, plot_rect, look, &band, time);
        let painter = ui
            .painter()
            .with_clip_rect(plot_rect.intersect(ui.clip_rect()));
        plot_marks::lines_ui(&painter, plot_rect, pane, time.span);
        if self.shows_thresholds(panel) {
            self.thresholds_ui(&painter, plot_rect, pane, &band);
        }
        let placing = Placing::of(plot_rect, time.span, &band);
        lines.ui(&painter, placing, look.palette);
        if lines.is_empty() {
            empty_ui(ui, plot_rect, look);
        }
        plot_ends::ends_ui(ui, plot_rect, look, lines.ends(placing));
        self.lines.insert(panel.kind, lines);
        plot_rect
    }

    fn thresholds_ui(&self, painter: &Painter, rect: Rect, pane: &Pane<'_>, band: &Band) {
        let joints = pane.state.hand().joints.iter();
        for (dof, joint) in joints.filter(|(dof, _)| !self.hidden[*dof]) {
            let color = pane.look.palette.dof[dof].gamma_multiply(0.7);
            let y = plot_axes::y_of(rect, band, f64::from(joint.force.get()));
            let ends = [pos2(rect.left(), y), pos2(rect.right(), y)];
            let stroke = Stroke::new(1.0, color);
            painter.extend(egui::Shape::dashed_line(&ends, stroke, 5.0, 4.0));
        }
    }

    /// Title, whether it is decimated, and the values under the pointer; over the curves, never on them.
    fn caption_ui(
        &self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        lines: &PlotLines,
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
        let fixed = self.ranges.is_chosen(panel.kind);
        let words = [
            (lines.decimated, plots::DECIMATED, plots::DECIMATED_TIP),
            (fixed, plots::RANGE_FIXED, plots::RANGE_TIP),
        ];
        let mut rest = rest;
        for (_, text, tip) in words.into_iter().filter(|(said, ..)| *said) {
            let text = look.say(text);
            let width = controls::text_width(ui, text, theme::tiny()) + 1.0;
            rest = rest.with_min_x(rest.left() + theme::GAP);
            if width <= rest.width() {
                Label::new(text, look.palette.faint)
                    .font(theme::tiny())
                    .put(ui, rest.with_max_x(rest.left() + width))
                    .on_hover_text(look.say(tip));
            }
            rest = rest.with_min_x(rest.left() + width);
        }
    }

    fn shows_thresholds(&self, panel: &Panel) -> bool {
        self.thresholds && panel.kind == PlotKind::Force
    }

    /// The lines of all shown plots and joints: what is copied and saved.
    pub(crate) fn shown_series(&self, pane: &Pane<'_>) -> Vec<Series> {
        let plots = &pane.state.settings.plots;
        let panels = PANELS.iter().filter(|panel| plots.shows(panel.kind));
        let lines = panels.flat_map(|panel| panel.lines(&self.hidden));
        lines.map(|line| line.series).collect()
    }
}

fn empty_ui(ui: &mut Ui, plot: Rect, look: Look) {
    let text = look.say(panels::PLOT_EMPTY);
    let width = controls::text_width(ui, text, theme::small()) + theme::PAD;
    let place = Rect::from_center_size(plot.center(), vec2(width, theme::TEXT_LINE));
    ui.painter().rect_filled(
        place,
        CornerRadius::same(theme::ROUND_TRACK),
        look.palette.sunken,
    );
    Label::new(text, look.palette.faint)
        .small()
        .center()
        .put(ui, place);
}

/// A length on the screen as a whole number, at least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a length in pixels, clamped"
)]
fn pixels(length: f32) -> u32 {
    length.clamp(1.0, COLUMNS_PX) as u32
}
