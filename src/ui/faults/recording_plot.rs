//! The plots of a recording: six drives as lanes of states, then the measured lines, all around the fault. Sends nothing.

use crate::app::readings::fault_recorder::{DriveState, Recording};
use crate::hand::{Dof, PerDof, Status};
use crate::history::Trace;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_right};
use crate::ui::kit::look::Look;
use crate::ui::plots::COLUMNS_PX;
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::axes::{Band, Extent};
use crate::ui::plots::bars as plot_bars;
use crate::ui::plots::plot_rows::{Panel, PlotLine};
use crate::ui::text::{faults, panels, words};
use crate::ui::theme;
use egui::{
    Align2, Color32, CornerRadius, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2,
    vec2,
};

/// Steps of the time axis, seconds.
const STEPS: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0];

/// Fewest and most times that are written below.
const TIMES_COUNTS: (f32, f32) = (2.0, 9.0);

/// What is drawn.
pub(crate) struct RecordingPlot<'a> {
    /// How it looks.
    pub(crate) look: Look,
    /// Of this recording.
    pub(crate) recording: &'a Recording,
    /// From and to, in seconds.
    pub(crate) span: (f64, f64),
    /// The moment that times are counted from, in seconds.
    pub(crate) fault_s: f64,
}

/// The height that is left for each of so many plots.
pub(crate) fn panel_height(rect: Rect, plots: usize) -> f32 {
    let count = f32::from(u8::try_from(plots.max(1)).unwrap_or(u8::MAX));
    (rect.height() - theme::PLOT_TIME_AXIS - lanes_height()) / count
}

const fn lanes_height() -> f32 {
    theme::RECORDING_CAPTION + 6.0 * theme::RECORDING_LANE + theme::STEP
}

impl RecordingPlot<'_> {
    /// Draws all of it.
    pub(crate) fn ui(&self, ui: &mut Ui, rect: Rect, shown: &[&Panel], trace: &mut Trace) {
        let ground = Rect::from_min_max(
            pos2(rect.left() + theme::PLOT_AXIS, rect.top()),
            pos2(rect.right(), rect.bottom() - theme::PLOT_TIME_AXIS),
        );
        let id = egui::Id::unique("plots of a recording");
        let response = ui.interact(ground, id, Sense::hover());
        let name = self.look.say(faults::RECORDING_AREA);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        let pointer = response.hover_pos();
        let pointer_s = pointer.map(|at| plot_axes::time_of(ground, self.span, at.x));
        self.lanes_ui(ui, ground, pointer_s);
        let height = panel_height(rect, shown.len());
        let mut top = rect.top() + lanes_height();
        for panel in shown {
            let place = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), height));
            self.panel_ui(ui, place, panel, trace, pointer_s);
            top += height;
        }
        self.time_ui(ui, ground.with_max_y(top), rect.bottom());
        if let Some(at) = pointer {
            let stroke = Stroke::new(1.0, self.look.palette.muted);
            ui.painter().vline(at.x, ground.y_range(), stroke);
        }
    }

    fn painter(ui: &Ui, rect: Rect) -> Painter {
        ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()))
    }

    fn is_of_fault(&self, dof: Dof) -> bool {
        self.recording.faults.iter().any(|fault| fault.dof == dof)
    }

    /// What each drive said, as a band of colours.
    fn lanes_ui(&self, ui: &mut Ui, ground: Rect, pointer_s: Option<f64>) {
        let look = self.look;
        let mut caption = Rect::from_min_size(
            pos2(ground.left() - theme::PLOT_AXIS, ground.top()),
            vec2(ground.width() + theme::PLOT_AXIS, theme::RECORDING_CAPTION),
        );
        if let Some(at_s) = pointer_s {
            for dof in Dof::ALL
                .into_iter()
                .rev()
                .filter(|dof| self.is_of_fault(*dof))
            {
                let states = self.recording.states(dof);
                let state = states.iter().find(|one| (one.0..=one.1).contains(&at_s));
                if let Some((_, _, state)) = state {
                    let text = self.state_words(*state);
                    value_ui(ui, &mut caption, &text, look.palette.dof[dof]);
                }
            }
        }
        Label::new(look.say(faults::LANES), look.palette.muted)
            .small()
            .put(ui, caption);
        for dof in Dof::ALL {
            let row = f32::from(u8::try_from(dof.index()).unwrap_or(0));
            let top = ground.top() + theme::RECORDING_CAPTION + row * theme::RECORDING_LANE;
            let lane = Rect::from_min_size(
                pos2(ground.left(), top),
                vec2(ground.width(), theme::RECORDING_LANE - 2.0),
            );
            let sign = Rect::from_min_size(
                lane.min - vec2(theme::LANE_SIGN_AT, 0.0),
                vec2(theme::LANE_SIGN, theme::RECORDING_LANE - 2.0),
            );
            ui.painter().rect_filled(sign, 1.0, look.palette.dof[dof]);
            ui.painter().rect_filled(lane, 1.0, look.palette.sunken);
            let painter = Self::painter(ui, lane);
            for (from_s, to_s, state) in self.recording.states(dof) {
                let x = |at_s| plot_axes::x_of(lane, self.span, at_s);
                let piece = Rect::from_x_y_ranges(x(from_s)..=x(to_s), lane.y_range());
                if let Some(color) = self.state_color(state) {
                    painter.rect_filled(piece, 0.0, color);
                }
            }
        }
    }

    fn state_color(&self, state: DriveState) -> Option<Color32> {
        let palette = self.look.palette;
        if state.faults.is_some_and(|bits| !bits.is_empty()) {
            return Some(palette.bad);
        }
        Some(match state.status? {
            Status::Releasing | Status::Grasping => palette.accent,
            Status::PositionReached => palette.ok.gamma_multiply(0.45),
            Status::ForceReached => palette.warn,
            Status::CurrentProtection | Status::Stalled | Status::DriveFault => palette.bad,
            Status::Unknown(_) => palette.faint,
        })
    }

    fn state_words(&self, state: DriveState) -> String {
        let language = self.look.language;
        let status = state
            .status
            .map(|status| words::status(status, language).title);
        let bits = state.faults.iter().flat_map(|bits| bits.iter());
        let bits = bits.map(|bit| words::fault(bit, language).title);
        let all: Vec<&str> = bits.chain(status).collect();
        all.join(" · ")
    }

    fn panel_ui(
        &self,
        ui: &mut Ui,
        rect: Rect,
        panel: &Panel,
        trace: &mut Trace,
        pointer_s: Option<f64>,
    ) {
        let look = self.look;
        let (mut caption, ground) =
            rect.split_top_bottom_at_y(rect.top() + theme::RECORDING_CAPTION);
        let ground = ground.with_max_y(ground.bottom() - 2.0);
        let plot = ground.with_min_x(ground.left() + theme::PLOT_AXIS);
        let lines = panel.lines(&PerDof::splat(false));
        if let Some(at_s) = pointer_s {
            let own = lines.iter().rev().filter(|line| !line.wished);
            for line in own.filter(|line| self.is_of_fault(line.dof)) {
                let reading = self.recording.history.reading(line.series, at_s);
                let text = reading.map_or_else(
                    || "-".to_owned(),
                    |reading| panel.value(reading.value.into()),
                );
                value_ui(ui, &mut caption, &text, look.palette.dof[line.dof]);
            }
        }
        Label::new(look.say(panel.title), look.palette.muted)
            .small()
            .put(ui, caption);
        let mut extent = Extent::default();
        for line in &lines {
            let all = self
                .recording
                .history
                .summary(line.series, self.span.0, self.span.1);
            if let Some(all) = all {
                extent.include(all.min.into());
                extent.include(all.max.into());
            }
        }
        let band = Band::of(panel.row.least_scale, &extent)
            .rounded(panel.row.scale_steps, plot.height() / theme::PLOT_NUMBER);
        plot_axes::value_axis_ui(ui, ground, look, &band);
        ui.painter().rect_filled(
            plot,
            CornerRadius::same(theme::ROUND_TRACK),
            look.palette.sunken,
        );
        for value in band.lines() {
            let y = plot_axes::y_of(plot, &band, value);
            let stroke = Stroke::new(1.0, look.palette.grid);
            ui.painter().hline(plot.x_range(), y, stroke);
        }
        let painter = Self::painter(ui, plot);
        let mut drawn = false;
        // The joints with the fault come last, over the others.
        for strong in [false, true] {
            let own = |line: &&PlotLine| self.is_of_fault(line.dof) == strong;
            for line in lines.iter().filter(own) {
                drawn |= self.line_ui(&painter, plot, &band, *line, trace);
            }
        }
        if !drawn {
            let text = look.say(panels::PLOT_EMPTY);
            Label::new(text, look.palette.faint)
                .small()
                .center()
                .put(ui, plot);
        }
    }

    /// True if there was something of it.
    fn line_ui(
        &self,
        painter: &Painter,
        plot: Rect,
        band: &Band,
        line: PlotLine,
        trace: &mut Trace,
    ) -> bool {
        let history = &self.recording.history;
        let (from_s, to_s) = self.span;
        history.trace(line.series, from_s, to_s, columns(plot), trace);
        let strong = self.is_of_fault(line.dof);
        let color = self.look.palette.dof[line.dof];
        let (width, share) = match (strong, line.wished) {
            (true, false) => (theme::LINE_STRONG, 1.0),
            (true, true) => (1.0, 0.6),
            (false, false) => (1.0, 0.35),
            (false, true) => (1.0, 0.15),
        };
        let stroke = Stroke::new(width, color.gamma_multiply(share));
        let place = |[at_s, value]: &[f64; 2]| {
            let x = plot_axes::x_of(plot, self.span, *at_s);
            pos2(x, plot_axes::y_of(plot, band, *value))
        };
        let mut mesh = egui::Mesh::default();
        for segment in &trace.segments {
            let places = segment.iter().map(place);
            if trace.decimated {
                plot_bars::add(&mut mesh, stroke, places);
            } else if line.wished {
                painter.line(steps(places), stroke);
            } else {
                painter.line(places.collect(), stroke);
            }
        }
        painter.add(mesh);
        !trace.segments.is_empty()
    }

    /// Times counted from the fault, and a line at each fault.
    fn time_ui(&self, ui: &Ui, ground: Rect, bottom: f32) {
        let look = self.look;
        let (from_s, to_s) = self.span;
        let most = f64::from(
            (ground.width() / theme::RECORDING_TIME).clamp(TIMES_COUNTS.0, TIMES_COUNTS.1),
        );
        let step = STEPS
            .into_iter()
            .find(|step| (to_s - from_s) / step <= most);
        let step = step.unwrap_or(30.0);
        let first = ((from_s - self.fault_s) / step).ceil() * step;
        for number in 0..16_u8 {
            let ago = first + f64::from(number) * step;
            let x = plot_axes::x_of(ground, self.span, self.fault_s + ago);
            if x > ground.right() + 0.5 {
                break;
            }
            let faint = Stroke::new(1.0, look.palette.grid);
            ui.painter()
                .vline(x, ground.top() + lanes_height()..=ground.bottom(), faint);
            let place = Rect::from_center_size(
                pos2(x, bottom - theme::PLOT_TIME_AXIS / 2.0),
                vec2(theme::RECORDING_TIME - theme::GAP, theme::MESSAGE_LINE),
            );
            let over = (place.right() - ground.right()).max(0.0);
            let place = place.translate(vec2(-over, 0.0));
            let text = if ago.abs() < 1e-9 {
                look.say(faults::RECORDING_FAULT).to_owned()
            } else {
                format!("{ago:+.0} s")
            };
            let (font, color) = (theme::number_small(), look.palette.faint);
            controls::paint_text(ui, place, Align2::CENTER_CENTER, &text, font, color);
        }
        let painter = Self::painter(ui, ground);
        for fault in &self.recording.faults {
            let x = plot_axes::x_of(ground, self.span, fault.at.secs());
            let color = look.palette.bad.gamma_multiply(0.8);
            painter.vline(x, ground.y_range(), Stroke::new(1.0, color));
        }
    }
}

/// One reading under the pointer, cut from the right of a caption.
fn value_ui(ui: &mut Ui, caption: &mut Rect, text: &str, color: Color32) {
    let width = controls::text_width(ui, text, theme::number_small()) + 1.0;
    if caption.width() < width + theme::RECORDING_WORDS {
        return;
    }
    let place = take_right(caption, width);
    Label::new(text, color)
        .font(theme::number_small())
        .right()
        .put(ui, place);
}

/// A value stands until the next one.
fn steps(places: impl Iterator<Item = Pos2>) -> Vec<Pos2> {
    let mut out: Vec<Pos2> = Vec::new();
    for place in places {
        let before = out.last().copied();
        out.extend(before.map(|before| pos2(place.x, before.y)));
        out.push(place);
    }
    out
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a width in pixels"
)]
fn columns(plot: Rect) -> usize {
    plot.width().clamp(1.0, COLUMNS_PX) as usize
}
