//! The force strip of a recording, painted by hand. Used in the list and below the timeline.

use crate::app::recordings::RecordingItem;
use crate::hand::Moment;
use crate::record::EventKind;
use crate::ui::kit::Look;
use crate::ui::recordings::marks;
use egui::{Color32, Painter, Rect, Stroke, pos2, vec2};

/// Minimum force at full height, in grams: a quiet recording must not look like a grasp.
const FULL_LEAST: f32 = 200.0;

/// Paints the maximum forces over a rectangle.
pub(crate) fn strip(painter: &Painter, look: Look, place: Rect, forces: &[f32]) {
    let full = forces.iter().copied().filter(|force| force.is_finite());
    let full = full.fold(FULL_LEAST, f32::max);
    let Some(width) = count(forces.len()).filter(|count| *count > 0.0) else {
        return;
    };
    let width = place.width() / width;
    // Opaque, so that no seam is visible where bars meet within a pixel.
    let color = look.palette.sunken.lerp_to_gamma(look.palette.accent, 0.7);
    let mut left = place.left();
    for equal in forces.chunk_by(|one, other| one == other) {
        let right = left + width * count(equal.len()).unwrap_or_default();
        if let Some(force) = equal.first().filter(|force| force.is_finite()) {
            let height = (force.max(0.0) / full * place.height()).max(1.0);
            let top = pos2(left, place.bottom() - height);
            let size = vec2((right - left).max(1.0), height);
            painter.rect_filled(Rect::from_min_size(top, size), 0.0, color);
        }
        left = right;
    }
}

/// Paints faults, stops and notes of a recording over its strip.
pub(crate) fn marks(painter: &Painter, look: Look, place: Rect, item: &RecordingItem) {
    let length = item.length.as_secs_f32().max(1e-3);
    for (at, color) in moments(look, item) {
        let x = place.left() + at.since(item.first).as_secs_f32() / length * place.width();
        painter.vline(x, place.y_range(), Stroke::new(1.0, color));
    }
}

/// Moments and colours of the marks.
pub(crate) fn moments(look: Look, item: &RecordingItem) -> Vec<(Moment, Color32)> {
    let is_marked = |kind| {
        matches!(
            kind,
            EventKind::Fault | EventKind::Stop | EventKind::LinkLost
        )
    };
    let marks = item.marks.iter().filter(|mark| is_marked(mark.kind));
    let marks = marks.filter_map(|mark| Some((mark.at, marks::shown(look, mark.kind)?.1)));
    let notes = item.notes().into_iter();
    let notes = notes.map(|note| (note.at(), look.palette.text));
    marks.chain(notes).collect()
}

fn count(len: usize) -> Option<f32> {
    u16::try_from(len).ok().map(f32::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::State;
    use egui::Shape;

    #[test]
    fn a_resting_hand_is_a_low_line_inside_the_place_of_the_strip() {
        let place = Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 24.0));
        let look = Look::of(&State::default());
        let ctx = egui::Context::default();
        let mut shown = ctx.run_ui(egui::RawInput::default(), |ui| {
            strip(ui.painter(), look, place, &[0.0, f32::NAN, 100.0, 200.0]);
        });
        shown.textures_delta.clear();
        let rects = shown.shapes.iter().filter_map(|shape| match &shape.shape {
            Shape::Rect(rect) if rect.fill != egui::Color32::TRANSPARENT => Some(rect.rect),
            _ => None,
        });
        let bars: Vec<Rect> = rects.filter(|rect| rect.width() == 200.0).collect();
        let heights: Vec<f32> = bars.iter().map(Rect::height).collect();
        assert_eq!(heights, [1.0, 12.0, 24.0], "nothing where nothing was read");
        assert!(bars.iter().all(|bar| place.contains_rect(*bar)), "{bars:?}");
    }
}
