//! Curves of trials over the time from a common moment, over each other. Knows no trial.

use crate::ui::plots::chart::{Chart, ChartResponse, ChartView, Points};
use crate::ui::plots::scales;
use crate::ui::plots::times::Times;
use egui::Ui;

/// The shortest time that is shown, s.
pub(crate) const LEAST_S: f64 = 0.1;

/// Time before the common moment that is shown at first, s.
const LEAD_S: f64 = 0.5;

/// Draws a chart over all the time of its lines; what was drawn, and the line at the pointer by its place in the list.
pub(crate) fn trial_chart_ui(
    ui: &mut Ui,
    chart: Chart<'_>,
    view: &mut ChartView,
) -> (ChartResponse, Option<usize>) {
    let spans = chart.curves.iter().filter_map(|curve| {
        let Points::Own([first, .., last]) = curve.points else {
            return None;
        };
        Some((first[0] - curve.zero[0], last[0] - curve.zero[0]))
    });
    let (from_s, to_s) = spans.fold(None, scales::joined).unwrap_or_default();
    let to_s = to_s.max(from_s + LEAST_S);
    // What comes long before a common contact is a flat line.
    let width = (to_s - from_s).min(to_s + LEAD_S);
    view.time.advance((from_s, to_s), width);
    let chart = Chart {
        times: Times::From(0.0, "0 s"),
        ..chart
    };
    let shown = chart.ui(ui, view);
    let near = chart.nearest(&shown);
    (shown, near)
}
