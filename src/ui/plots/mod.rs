//! The stacked plots over one time: what was measured, what happened, and what lies between two cursors.
pub(crate) mod bars;
pub(crate) mod chart;
pub(crate) mod cursors;
pub(crate) mod head;
pub(crate) mod marks;
pub(crate) mod panels;
pub(crate) mod scales;
pub(crate) mod time_window;

use crate::app::settings::PlotKind;
use crate::hand::{Dof, PerDof};
use crate::history::{Series, Trace};
use crate::transport::Endpoint;
use crate::ui::kit::controls;
use crate::ui::kit::format::UNKNOWN;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::plots::chart::{Chart, ChartResponse, ChartView, Curve, Times};
use crate::ui::plots::cursors::Cursors;
use crate::ui::plots::panels::{PANELS, Panel, PlotLine};
use crate::ui::text::panels as text;
use crate::ui::theme;
use egui::{Color32, Stroke, Ui};
use std::collections::HashMap;

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
    /// True if a note was asked for in this frame.
    pub(crate) note_asked: bool,
    /// Width and height of the card in points, for a picture of it.
    size: (f32, f32),
    /// Rows that were copied last, while the menu is open.
    copied: Option<usize>,
    /// Points of lines; of a line that goes on only the newest are fetched.
    traces: HashMap<Series, Trace>,
    /// The time that the pointer was at in the last frame.
    pointed_s: Option<f64>,
    /// The hand that is shown.
    hand: Option<Endpoint>,
}

impl PlotView {
    /// Draws the card with all plots.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.advance(pane);
        self.size = ui.available_size().into();
        controls::card_ui(ui, pane.look, |ui| {
            head::head_ui(ui, pane, self);
            head::legend_ui(ui, pane.look, self);
            self.body_ui(ui, pane);
        });
    }

    /// Time went on; nothing that was chosen for one hand is kept for another.
    fn advance(&mut self, pane: &Pane<'_>) {
        let hand = pane.state.hand();
        if self.hand != hand.endpoint && hand.endpoint.is_some() {
            self.hand.clone_from(&hand.endpoint);
            self.view.time.follow();
            self.cursors = Cursors::default();
        }
        let now = pane.state.now.secs();
        let first = hand.history.first_secs().unwrap_or(now);
        let window = pane.state.settings.plot_window.seconds();
        self.view.time.advance((first.min(now), now), window);
    }

    fn body_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let plots = pane.state.settings.plots;
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
            if room(ui, shown.len()) < theme::PLOT_LEAST {
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
        let mut pointed_s = None;
        for (n, panel) in shown.iter().enumerate() {
            let is_lowest = n + 1 == shown.len();
            let height = height
                + if is_lowest {
                    theme::PLOT_TIME_AXIS
                } else {
                    0.0
                };
            let chart = self.panel_ui(ui, pane, panel, (height, is_lowest));
            pointed_s = pointed_s.or(chart.pointed_s());
            if n == 0 {
                marks::words_ui(ui, pane, &chart);
            }
            if is_lowest {
                self.cursors.flags_ui(ui, pane.look, &chart);
            }
            if chart.ground.clicked() {
                self.chosen = Some(panel.kind);
            }
            if let Some(marks) = marks::near(pane, &chart) {
                chart.ground.on_hover_text_at_pointer(marks);
            }
        }
        self.pointed_s = pointed_s;
    }

    /// One plot under its caption.
    fn panel_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        panel: &Panel,
        (height, is_lowest): (f32, bool),
    ) -> ChartResponse {
        let look = pane.look;
        let hand = pane.state.hand();
        let lines = panel.lines(&self.hidden);
        let (from_s, to_s) = self.view.time.span();
        let mut extent = None;
        let mut is_decimated = false;
        for line in &lines {
            let trace = self.traces.entry(line.series).or_default();
            hand.history
                .trace(line.series, from_s, to_s, chart::columns(ui), trace);
            is_decimated |= trace.decimated && !line.wished;
            if let Some(all) = hand.history.summary(line.series, from_s, to_s) {
                extent = scales::joined(extent, (all.min.into(), all.max.into()));
            }
        }
        let mut levels = Vec::new();
        if self.thresholds && panel.kind == PlotKind::Force {
            for (dof, joint) in hand.joints.iter().filter(|(dof, _)| !self.hidden[*dof]) {
                let grams = f64::from(joint.force.get());
                extent = scales::joined(extent, (grams, grams));
                levels.push((grams, look.palette.dof[dof].gamma_multiply(0.7)));
            }
        }
        let readings = self
            .pointed_s
            .map(|at_s| readings(pane, panel, (&lines, at_s)));
        let own = |line: &PlotLine| Some((*line, self.traces.get(&line.series)?));
        let own = lines.iter().filter_map(own).flat_map(|(line, trace)| {
            let stroke = stroke(look, line, self.pointed);
            trace.segments.iter().map(move |points| Curve {
                steps: line.wished,
                ..Curve::new(points, stroke)
            })
        });
        let now = (!self.view.time.is_held()).then_some(to_s);
        let times = now.map_or(Times::Clock, |now| Times::From(now, look.say(text::NOW)));
        let chart = Chart {
            title: panel.title,
            curves: own.collect(),
            levels,
            moments: marks::moments(pane, (from_s, to_s)),
            cursors: self.cursors.0,
            scale: scales::rounded(panel.row.least_scale, extent, height - theme::PLOT_CAPTION),
            times: is_lowest.then_some(times),
            readings: readings.unwrap_or_default(),
            is_decimated,
            ..Chart::new(look, height)
        };
        let shown = chart.ui(ui, &mut self.view);
        let scale = shown.transform.bounds().range_y().into_inner();
        self.view
            .scales
            .ends_ui(&shown.axis, pane, panel.title, scale);
        shown
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

/// Height of each of so many plots.
fn room(ui: &Ui, count: usize) -> f32 {
    let count = f32::from(u8::try_from(count).unwrap_or(u8::MAX));
    ((ui.available_height() - theme::PLOT_TIME_AXIS) / count).floor()
}

fn stroke(look: Look, line: PlotLine, pointed: Option<Dof>) -> Stroke {
    let color = look.palette.dof[line.dof];
    let color = match pointed {
        Some(dof) if dof != line.dof => color.gamma_multiply(BEHIND_PART),
        _ => color,
    };
    match line.wished {
        true => Stroke::new(1.0, color.gamma_multiply(WISHED_PART)),
        false => Stroke::new(theme::LINE, color),
    }
}

/// The values of lines at a time, in their colours.
fn readings(
    pane: &Pane<'_>,
    panel: &Panel,
    (lines, at_s): (&[PlotLine], f64),
) -> Vec<(Color32, String)> {
    let history = &pane.state.hand().history;
    let read = |line: &PlotLine| {
        let reading = history.reading(line.series, at_s);
        let value = reading.map(|reading| panel.value(reading.value.into()));
        let color = pane.look.palette.dof[line.dof];
        (color, value.unwrap_or_else(|| UNKNOWN.to_owned()))
    };
    lines.iter().filter(|line| !line.wished).map(read).collect()
}
