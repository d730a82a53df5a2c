//! Newest values at the right ends of the curves, each in its curve's colour, and spread where curves meet, so that equal curves
//! remain distinguishable. A click hides a joint's curves.

use crate::hand::Dof;
use crate::ui::kit::{self, Label, Look, format};
use crate::ui::plots::chart::ChartResponse;
use crate::ui::plots::panels::Panel;
use crate::ui::text::{panels, words};
use crate::ui::theme;
use egui::{Color32, CursorIcon, Rangef, Rect, Response, Role, Stroke, Ui, WidgetInfo, pos2};

/// Minimum width at which names are shown.
const NAMED_FROM: f32 = 600.0;
/// Distance from the end of a curve to its value.
const LEADER: f32 = 8.0;
/// Pixels per point from which a touch screen is assumed.
const TOUCHED: f32 = 1.5;
/// Distance from the end of a curve to the right edge of its value.
pub(crate) const VALUES: f32 = LEADER + VALUE;
/// Width of a value.
const VALUE: f32 = 40.0;
/// Width of a name.
const NAME: f32 = 88.0;

/// The end of a curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveEnd {
    pub(crate) dof: Dof,
    /// `None` if unknown.
    pub(crate) value: Option<f64>,
    pub(crate) color: Color32,
}

/// Space at the right of plots as wide as `ui`.
pub(crate) fn width(ui: &Ui) -> f32 {
    let name = if ui.available_width() < NAMED_FROM {
        0.0
    } else {
        NAME
    };
    VALUES + theme::STEP + name
}

/// A plot whose curves are labelled at their right ends.
pub(crate) struct PlotEnds<'a> {
    pub(crate) look: Look,
    pub(crate) panel: &'a Panel,
    pub(crate) chart: &'a ChartResponse,
}

impl PlotEnds<'_> {
    /// Draws the ends. Returns the hovered joint, and true if it was clicked.
    pub(crate) fn ui(&self, ui: &Ui, ends: &[CurveEnd]) -> Option<(Dof, bool)> {
        if ends.iter().all(|end| end.value.is_none()) {
            return None;
        }
        let chart = self.chart;
        let frame = *chart.transform.frame();
        let right = frame.right() + width(ui);
        let place = |end: &CurveEnd| {
            let y = |value| chart.transform.position_from_point_y(value);
            let y = end.value.map_or(frame.bottom(), y);
            y.clamp(frame.top(), frame.bottom())
        };
        let mut ends: Vec<(f32, &CurveEnd)> = ends.iter().map(|end| (place(end), end)).collect();
        ends.sort_by(|one, other| one.0.total_cmp(&other.0));
        let wanted: Vec<f32> = ends.iter().map(|(y, _)| *y).collect();
        let count = f32::from(u8::try_from(ends.len()).unwrap_or(u8::MAX));
        let pitch = (frame.height() / count).min(theme::TEXT_LINE);
        let middles = apart(&wanted, pitch, frame.y_range());
        let mut pointed = None;
        for ((y, end), middle) in ends.into_iter().zip(middles) {
            let ys = Rangef::new(middle - pitch / 2.0, middle + pitch / 2.0);
            let xs = Rangef::new(frame.right() + LEADER, right);
            let place = Rect::from_x_y_ranges(xs, ys);
            if end.value.is_some() {
                let leader = Stroke::new(1.0, end.color.gamma_multiply(0.6));
                let line = [pos2(frame.right(), y), pos2(xs.min, middle)];
                ui.painter().line_segment(line, leader);
            }
            let response = self.end_ui(ui, end, place);
            if response.hovered() {
                pointed = Some((end.dof, response.clicked()));
            }
        }
        pointed
    }

    /// Draws the value of one curve, and its name if it fits.
    fn end_ui(&self, ui: &Ui, end: &CurveEnd, place: Rect) -> Response {
        let (look, panel) = (self.look, self.panel);
        let name = look.tr(words::dof(end.dof));
        let id = ui.scope_id().with((panel.title.en, end.dof.index()));
        // On a touch screen a finger would hide the wrong curve: use the menu there.
        let sense = kit::click_if(ui.pixels_per_point() < TOUCHED);
        let response = ui.interact(place, id, sense);
        let named = look.pair(look.tr(panel.title), name);
        let role = if sense.interactive() {
            Role::Button
        } else {
            Role::Label
        };
        response.widget_info(|| WidgetInfo::selected(role, true, true, &named));
        let digits = panel.row.decimals;
        let text = end.value.map(|value| format!("{value:.digits$}"));
        let text = text.unwrap_or_else(|| format::UNKNOWN.to_owned());
        let (value, rest) = place.split_left_right_at_x(place.left() + VALUE);
        let label = Label::new(&text, end.color).number().right();
        label.paint(ui, value);
        if rest.width() > VALUE {
            let label = Label::new(name, end.color).small();
            label.paint(ui, rest.with_min_x(rest.left() + theme::STEP));
        }
        let tip = format!("{name}\n{}", look.tr(panels::HIDE_CURVE));
        response
            .on_hover_cursor(CursorIcon::PointingHand)
            .on_hover_text(tip)
    }
}

/// Spreads the centres to at least `pitch` apart, as near to `wanted` as `room` permits, in the same order.
fn apart(wanted: &[f32], pitch: f32, room: Rangef) -> Vec<f32> {
    // Groups that touch: their size, and the mean of the positions that their first members want.
    let mut groups: Vec<(f32, f32)> = Vec::new();
    let within = |(count, first): (f32, f32)| {
        let last = room.max - pitch * (count - 0.5);
        first.min(last).max(room.min + pitch / 2.0)
    };
    for y in wanted {
        let mut group = (1.0, *y);
        while let Some(before) =
            groups.pop_if(|before| within(*before) + pitch * before.0 > within(group))
        {
            let count = before.0 + group.0;
            let first = (before.0 * before.1 + group.0 * (group.1 - pitch * before.0)) / count;
            group = (count, first);
        }
        groups.push(group);
    }
    let mut middles = Vec::with_capacity(wanted.len());
    for group in groups {
        let mut middle = within(group);
        let mut left = group.0;
        while left >= 1.0 {
            middles.push(middle);
            middle += pitch;
            left -= 1.0;
        }
    }
    middles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_equal_curves_stand_apart_and_within_the_plot() {
        let room = Rangef::new(0.0, 100.0);
        for (wanted, middles) in [
            (&[20.0, 60.0][..], &[20.0, 60.0][..]),
            (&[50.0, 50.0, 50.0], &[34.0, 50.0, 66.0]),
            (&[100.0, 100.0, 100.0], &[60.0, 76.0, 92.0]),
            (&[0.0, 0.0, 90.0], &[8.0, 24.0, 90.0]),
            (&[20.0, 70.0, 74.0], &[20.0, 64.0, 80.0]),
            (&[80.0, 99.0, 99.0], &[60.0, 76.0, 92.0]),
        ] {
            assert_eq!(apart(wanted, 16.0, room), middles, "{wanted:?}");
        }
    }
}
