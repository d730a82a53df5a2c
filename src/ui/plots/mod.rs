//! The stacked plots over one time: what was measured, what happened, and what lies between two cursors.
pub(crate) mod bars;
pub(crate) mod chart;
pub(crate) mod cursors;
pub(crate) mod head;
pub(crate) mod legend;
pub(crate) mod marks;
pub(crate) mod notes;
pub(crate) mod panels;
pub(crate) mod scales;
pub(crate) mod time_window;
pub(crate) mod times;

use crate::app::settings::PlotKind;
use crate::hand::{Dof, PerDof};
use crate::history::Series;
use crate::transport::Endpoint;
use crate::ui::kit::{self, Look, Pane, dash};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartResponse, ChartView, Points};
use crate::ui::plots::cursors::Cursors;
use crate::ui::plots::panels::{PANELS, Panel, PanelLine};
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::plots::times::Times;
use crate::ui::text::panels as text;
use crate::ui::theme;
use egui::{Stroke, Ui};

/// What was asked for is paler than what was measured.
const WISHED_PART: f32 = 0.45;
/// So pale are all joints but the one that the pointer is at in the legend.
const BEHIND_PART: f32 = 0.2;

/// What the plots need between frames.
#[derive(Debug, Default)]
pub(crate) struct PlotView {
    /// Which time is shown, on which scales.
    pub(crate) view: ChartView,
    /// Joints whose curves are hidden.
    hidden: PerDof<bool>,
    /// The joint that the pointer is at in the legend.
    pointed: Option<Dof>,
    /// Whether thresholds are shown.
    thresholds: bool,
    cursors: Cursors,
    /// The plot whose figures are told.
    chosen: Option<PlotKind>,
    /// True while the plots fill the view.
    pub(crate) large: bool,
    /// Width and height of the card in points, for a picture of it.
    size: (f32, f32),
    /// The hand that is shown.
    hand: Option<Endpoint>,
}

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.advance(pane);
        self.size = ui.available_size().into();
        kit::card_ui(ui, pane.look, |ui| {
            head::head_ui(ui, pane, self);
            head::legend_ui(ui, pane.look, self);
            self.body_ui(ui, pane);
        });
    }

    /// Shows just this stretch of time.
    pub(crate) const fn pin(&mut self, span: TimeSpan) {
        self.view.time.pin(span);
    }

    /// Time went on; nothing that was chosen for one hand is kept for another.
    fn advance(&mut self, pane: &Pane<'_>) {
        let hand = pane.state.hand();
        if self.hand != hand.connection.endpoint && hand.connection.endpoint.is_some() {
            self.hand.clone_from(&hand.connection.endpoint);
            self.view.time.follow();
            self.cursors = Cursors::default();
        }
        let now = pane.state.now.secs();
        let first = hand.measured.history.first_secs().unwrap_or(now);
        let window = pane.state.settings.plot_window.seconds();
        self.view.time.advance((first.min(now), now), window);
    }

    fn body_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let plots = &pane.state.settings.plots;
        let shown = PANELS.iter().filter(|panel| plots.shows(panel.kind));
        let mut shown: Vec<&Panel> = shown.collect();
        let at = shown
            .iter()
            .position(|panel| Some(panel.kind) == self.chosen);
        let at = at.unwrap_or_default();
        let Some(chosen) = shown.get(at).copied() else {
            return;
        };
        if self.cursors.0.is_some() {
            let measured = chosen.measured(&self.hidden);
            let table = egui::Panel::bottom("figures of the cursors").frame(egui::Frame::NONE);
            let table = table
                .show_separator_line(false)
                .show(ui, |ui| self.cursors.table_ui(ui, pane, chosen, &measured));
            if table.inner {
                let next = shown.get(at + 1).or(shown.first());
                self.chosen = next.map(|panel| panel.kind);
            }
            if room(ui, shown.len()) < 62.0 {
                shown = vec![chosen];
            }
        }
        let height = room(ui, shown.len());
        ui.spacing_mut().item_spacing.y = 0.0;
        // In a window that was forced to be tiny there is no place to draw in.
        if height > theme::PLOT_CAPTION + theme::PLOT_NUMBER
            && ui.available_width() > 4.0 * theme::PLOT_AXIS
        {
            self.stack_ui(ui, pane, &shown, height);
        }
    }

    fn stack_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, shown: &[&Panel], height: f32) {
        for (n, panel) in shown.iter().enumerate() {
            let is_lowest = n + 1 == shown.len();
            let height = height
                + if is_lowest {
                    theme::PLOT_TIME_AXIS
                } else {
                    0.0
                };
            let chart = self.panel_ui(ui, pane, panel, (height, is_lowest));
            if n == 0 {
                marks::words_ui(ui, pane, &chart);
            }
            if is_lowest {
                self.cursors.flags_ui(ui, pane.look, &chart);
            }
            if chart.response.clicked() {
                self.chosen = Some(panel.kind);
            }
            if let Some(marks) = marks::near(pane, &chart) {
                chart.response.on_hover_text_at_pointer(marks);
            }
        }
    }

    fn panel_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        panel: &Panel,
        place: (f32, bool),
    ) -> ChartResponse {
        let look = pane.look;
        let hand = pane.state.hand();
        let curve = |line: &PanelLine| ChartCurve {
            steps: line.wished,
            told: (!line.wished).then_some(panel.row.decimals),
            ..ChartCurve::new(
                Points::Measured(&hand.measured.history, line.series),
                self.stroke(look, line),
            )
        };
        let lines = panel.lines(&self.hidden);
        // The second session stands behind the first.
        let beside = pane.state.beside.iter().flat_map(|beside| {
            let measured = lines.iter().filter(|line| !line.wished);
            measured.map(|line| ChartCurve {
                zero: [beside.offset_s(), 0.0],
                style: dash::nth(1),
                beside: true,
                ..ChartCurve::new(
                    Points::Measured(&beside.history, line.series),
                    self.stroke(look, line),
                )
            })
        });
        let mut levels = Vec::new();
        if self.thresholds && panel.kind == PlotKind::Force {
            let shown = Dof::ALL.into_iter().filter(|dof| !self.hidden[*dof]);
            let level = |dof: Dof| {
                let stops_at = hand.stops_at(dof)?;
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
            times: if self.view.time.is_held() {
                Times::Clock
            } else {
                Times::From(span.1, look.say(text::NOW))
            },
            is_lowest: place.1,
            ..Chart::new(look, panel.title, place.0)
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

    /// Size of the card, for a picture of it.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a length on a screen, cut to the ends of the whole numbers"
    )]
    const fn pixels(&self) -> (u32, u32) {
        (self.size.0 as u32, self.size.1 as u32)
    }

    /// The lines of all shown plots and joints: what is copied and saved.
    fn shown_series(&self, pane: &Pane<'_>) -> Vec<Series> {
        let plots = &pane.state.settings.plots;
        let panels = PANELS.iter().filter(|panel| plots.shows(panel.kind));
        let lines = panels.flat_map(|panel| panel.lines(&self.hidden));
        lines.map(|line| line.series).collect()
    }
}

/// Height of each of so many plots above their time axis.
pub(crate) fn room(ui: &Ui, count: usize) -> f32 {
    let count = f32::from(u8::try_from(count).unwrap_or(u8::MAX));
    ((ui.available_height() - theme::PLOT_TIME_AXIS) / count).floor()
}
