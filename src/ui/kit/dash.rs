//! Kinds of strokes: lines of one colour that an eye tells apart. Knows no plot.

use egui::{Color32, Painter, Rect, Shape, Stroke};
use egui_plot::LineStyle;

/// The kinds in their order, round and round.
pub(crate) const fn nth(number: usize) -> LineStyle {
    match number % 4 {
        0 => LineStyle::Solid,
        1 => LineStyle::Dashed { length: 9.0 },
        2 => LineStyle::Dotted { spacing: 5.0 },
        _ => LineStyle::Dashed { length: 4.0 },
    }
}

/// Draws a sign of one across the middle of a place.
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

/// The colour of lines that stand back behind another one.
pub(crate) fn behind(color: Color32) -> Color32 {
    color.gamma_multiply(0.3)
}
