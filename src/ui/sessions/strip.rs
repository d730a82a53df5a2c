//! The strip of force of a session: an instrument, painted by hand. The same in the list and under the time line.

use crate::ui::kit::Look;
use egui::{Painter, Rect, Shape, Stroke, pos2};

/// A force that fills the strip at least, in grams: a quiet session does not look like a grasp.
const FULL_LEAST: f32 = 200.0;

/// Paints the greatest forces over a place.
pub(crate) fn strip(painter: &Painter, look: Look, place: Rect, forces: &[f32]) {
    let full = forces.iter().copied().filter(|force| force.is_finite());
    let full = full.fold(FULL_LEAST, f32::max);
    let Some(width) = count(forces.len()).filter(|count| *count > 0.0) else {
        return;
    };
    let width = place.width() / width;
    let stroke = Stroke::new(width.max(1.0), look.palette.accent.gamma_multiply(0.7));
    let mut left = place.left() + width / 2.0;
    for force in forces {
        if force.is_finite() {
            let height = (force.max(0.0) / full * place.height()).max(1.0);
            let top = pos2(left, place.bottom() - height);
            let line = [pos2(left, place.bottom()), top];
            painter.add(Shape::line_segment(line, stroke));
        }
        left += width;
    }
}

fn count(len: usize) -> Option<f32> {
    u16::try_from(len).ok().map(f32::from)
}
