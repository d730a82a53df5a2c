//! Line styles that keep curves of one colour distinguishable. Independent of the plots.

use egui::{Color32, Painter, Rect, Shape, Stroke};
use egui_plot::LineStyle;

/// Returns the line style with this number, cycling through four.
pub(crate) const fn nth(number: usize) -> LineStyle {
    match number % 4 {
        0 => LineStyle::Solid,
        1 => LineStyle::Dashed { length: 9.0 },
        2 => LineStyle::Dotted { spacing: 5.0 },
        _ => LineStyle::Dashed { length: 4.0 },
    }
}

/// Draws a sample of a line style across the middle of `place`.
pub(crate) fn sample(painter: &Painter, place: Rect, style: LineStyle, stroke: Stroke) {
    let ends = [place.left_center(), place.right_center()];
    match style {
        LineStyle::Solid => painter.extend([Shape::line_segment(ends, stroke)]),
        LineStyle::Dashed { length } => {
            painter.extend(Shape::dashed_line(&ends, stroke, length, length * 0.6));
        }
        LineStyle::Dotted { spacing } => {
            let radius = stroke.width * 0.7;
            painter.extend(Shape::dotted_line(&ends, stroke.color, spacing, radius));
        }
    }
}

/// Colour of lines in the background of another one.
pub(crate) fn behind(color: Color32) -> Color32 {
    color.gamma_multiply(0.3)
}
