//! The plots of a recording: six drives as lanes of states, then the measured lines, all around the fault. Sends nothing.

use crate::app::readings::fault_recorder::{DriveState, Recording, RecordingId};
use crate::hand::{Dof, PerDof, Status};
use crate::ui::kit::{Label, Look};
use crate::ui::plots::chart::{Chart, ChartView, Curve, Points};
use crate::ui::plots::panels::{Panel, PlotLine};
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::plots::times::Times;
use crate::ui::text::{faults, words};
use crate::ui::theme;
use egui::{Color32, Rect, Stroke, Ui, UiBuilder, vec2};

/// Height of one drive's lane, with its gap.
const RECORDING_LANE: f32 = 8.0;

/// What the plots of a recording need between frames.
#[derive(Debug, Default)]
pub(crate) struct RecordingCharts {
    of: Option<(RecordingId, TimeSpan)>,
    view: ChartView,
}

/// What is drawn.
pub(crate) struct RecordingPlot<'a> {
    /// How it looks.
    pub(crate) look: Look,
    /// Of this recording.
    pub(crate) recording: &'a Recording,
    /// From and to, in seconds.
    pub(crate) span: TimeSpan,
    /// The moment that times are counted from, in seconds.
    pub(crate) fault_s: f64,
}

/// The height that is left for each of so many plots.
pub(crate) fn panel_height(rect: Rect, plots: usize) -> f32 {
    let count = f32::from(u8::try_from(plots.max(1)).unwrap_or(u8::MAX));
    let lanes = theme::PLOT_CAPTION + 6.0 * RECORDING_LANE;
    (rect.height() - theme::PLOT_TIME_AXIS - lanes) / count
}

impl RecordingPlot<'_> {
    /// Draws all of it.
    pub(crate) fn ui(
        &self,
        ui: &mut Ui,
        rect: Rect,
        shown: &[&Panel],
        charts: &mut RecordingCharts,
    ) {
        let of = (self.recording.id, self.span);
        if charts.of != Some(of) {
            *charts = RecordingCharts {
                of: Some(of),
                ..RecordingCharts::default()
            };
        }
        let (from_s, to_s) = self.span;
        charts.view.time.advance(self.span, to_s - from_s);
        let height = panel_height(rect, shown.len());
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            self.lanes_ui(ui, &charts.view);
            for (n, panel) in shown.iter().enumerate() {
                let is_lowest = n + 1 == shown.len();
                let height = height
                    + if is_lowest {
                        theme::PLOT_TIME_AXIS
                    } else {
                        0.0
                    };
                self.chart(panel, height, is_lowest)
                    .ui(ui, &mut charts.view);
            }
        });
    }

    fn is_of_fault(&self, dof: Dof) -> bool {
        self.recording.faults.iter().any(|fault| fault.dof == dof)
    }

    /// What each drive said, as a band of colours.
    fn lanes_ui(&self, ui: &mut Ui, view: &ChartView) {
        let span = view.time.span();
        let palette = self.look.palette;
        ui.horizontal(|ui| {
            ui.set_height(theme::PLOT_CAPTION);
            Label::note(self.look, faults::LANES).ui(ui);
            for (dof, at_s) in Dof::ALL
                .into_iter()
                .zip(view.pointed_s().into_iter().cycle())
            {
                let mut states = self.recording.states(dof).into_iter();
                let state = states.find(|one| (one.0..=one.1).contains(&at_s));
                if let Some((_, _, state)) = state.filter(|_| self.is_of_fault(dof)) {
                    Label::new(&self.state_words(state), palette.dof[dof])
                        .small()
                        .ui(ui);
                }
            }
        });
        for dof in Dof::ALL {
            let place = vec2(ui.available_width(), RECORDING_LANE);
            let lane = ui.allocate_space(place).1.shrink2(vec2(0.0, 1.0));
            let (sign, lane) = lane.split_left_right_at_x(lane.left() + theme::PLOT_AXIS);
            let sign = sign
                .with_min_x(sign.right() - 2.0 * theme::STEP)
                .with_max_x(sign.right() - 2.0);
            ui.painter().rect_filled(sign, 1.0, palette.dof[dof]);
            ui.painter().rect_filled(lane, 1.0, palette.sunken);
            let x = |at_s| {
                egui::remap_clamp(
                    at_s,
                    span.0..=span.1,
                    f64::from(lane.left())..=f64::from(lane.right()),
                )
            };
            for (from_s, to_s, state) in self.recording.states(dof) {
                #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
                let piece =
                    Rect::from_x_y_ranges(x(from_s) as f32..=x(to_s) as f32, lane.y_range());
                if let Some(color) = self.state_color(state) {
                    ui.painter().rect_filled(piece, 0.0, color);
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

    fn chart(&self, panel: &Panel, height: f32, is_lowest: bool) -> Chart<'_> {
        let mut lines = panel.lines(&PerDof::splat(false));
        // The joints with the fault come last, over the others.
        lines.sort_by_key(|line| self.is_of_fault(line.dof));
        let curve = |line: PlotLine| {
            let is_of_fault = self.is_of_fault(line.dof);
            let (width, share) = match (is_of_fault, line.wished) {
                (true, false) => (theme::STRONG, 1.0),
                (true, true) => (1.0, 0.6),
                (false, false) => (1.0, 0.35),
                (false, true) => (1.0, 0.15),
            };
            let color = self.look.palette.dof[line.dof].gamma_multiply(share);
            let points = Points::Measured(&self.recording.history, line.series);
            Curve {
                steps: line.wished,
                told: (is_of_fault && !line.wished).then_some(panel.row.decimals),
                ..Curve::new(points, Stroke::new(width, color))
            }
        };
        let bad = self.look.palette.bad;
        let faults = self.recording.faults.iter();
        Chart {
            curves: lines.into_iter().map(curve).collect(),
            moments: faults.map(|fault| (fault.at.secs(), bad)).collect(),
            least: panel.row.least_scale,
            times: Times::From(self.fault_s, self.look.say(faults::RECORDING_FAULT)),
            is_lowest,
            ..Chart::new(self.look, panel.title, height)
        }
    }
}
