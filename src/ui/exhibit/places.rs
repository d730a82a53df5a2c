//! Layout of the page for a screen size.

use egui::{Rect, pos2, vec2};

/// Minimum size of anything touched, in points.
const TOUCHED_LEAST: f32 = 48.0;
/// Minimum height and width of a tile, in points.
const TILE_LEAST: f32 = 72.0;
/// Height of a tile's name, in units.
pub(crate) const NAME: f32 = 52.0;

/// Rectangles of all parts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PagePlaces {
    /// Points per unit: a screen of 1920 by 1080, or of 1080 by 1920, has that many units.
    pub(crate) unit: f32,
    pub(crate) whole: Rect,
    /// Logo and title.
    pub(crate) title: Rect,
    /// Language button.
    pub(crate) language: Rect,
    /// Lock button for staff.
    pub(crate) lock: Rect,
    /// The drawn hand and its fingertips.
    pub(crate) hand: Rect,
    /// Text of the current stage.
    pub(crate) words: Rect,
    pub(crate) tiles: Rect,
    pub(crate) stop: Rect,
}

impl PagePlaces {
    /// Layout for a screen of this size.
    pub(crate) fn of(whole: Rect) -> Self {
        let is_upright = whole.height() > whole.width();
        let designed = if is_upright {
            vec2(1080.0, 1920.0)
        } else {
            vec2(1920.0, 1080.0)
        };
        let unit = (whole.size() / designed).min_elem();
        let gap = 20.0 * unit;
        let inner = whole.shrink(32.0 * unit);
        let touched = (76.0 * unit).max(TOUCHED_LEAST);
        let (head, body) = above(inner, touched, gap);
        let (head, lock) = before(head, touched, gap);
        let (title, language) = before(head, 2.4 * touched, gap);
        let stop = (if is_upright { 170.0 } else { 132.0 }) * unit;
        let (hand, rest) = if is_upright {
            above(body, body.height() * 0.44, gap)
        } else {
            let (hand, rest) =
                body.split_left_right_at_x(body.left() + (body.width() - gap) * 0.42);
            (hand, rest.with_min_x(rest.left() + gap))
        };
        let (words, rest) = above(rest, 192.0 * unit, gap);
        let (tiles, stop) = above(rest, rest.height() - stop - gap, gap);
        Self {
            unit,
            whole,
            title,
            language,
            lock,
            hand,
            words,
            tiles,
            stop,
        }
    }

    /// Area for the staff panel: it never covers STOP.
    pub(crate) fn staff(&self) -> Rect {
        let room = self.whole.shrink(32.0 * self.unit);
        Rect::from_min_max(
            pos2(room.left(), self.title.bottom() + 12.0 * self.unit),
            pos2(room.right(), self.stop.top() - 20.0 * self.unit),
        )
    }

    /// Rectangles of `count` tiles, with the number of columns that makes their pictures largest.
    pub(crate) fn tile_rects(&self, count: usize) -> Vec<Rect> {
        let (gap, room) = (16.0 * self.unit, self.tiles);
        let count = u8::try_from(count).unwrap_or(u8::MAX).max(1);
        let size = |columns: u8| {
            let grid = vec2(columns.into(), count.div_ceil(columns).into());
            (room.size() + egui::Vec2::splat(gap)) / grid - egui::Vec2::splat(gap)
        };
        let picture = |columns: u8| {
            let size = size(columns);
            let fits = if size.min_elem() >= TILE_LEAST {
                1.0
            } else {
                0.01
            };
            size.x.min(size.y - NAME * self.unit) * fits
        };
        let columns = (1..=count).max_by(|a, b| picture(*a).total_cmp(&picture(*b)));
        let columns = columns.unwrap_or(1);
        let size = size(columns);
        let at = |index: u8| {
            let place = vec2((index % columns).into(), (index / columns).into());
            Rect::from_min_size(room.min + place * (size + egui::Vec2::splat(gap)), size)
        };
        (0..count).map(at).collect()
    }
}

/// Splits off the upper part of this height; the rest begins after a gap.
pub(crate) fn above(rect: Rect, height: f32, gap: f32) -> (Rect, Rect) {
    let (upper, lower) = rect.split_top_bottom_at_y(rect.top() + height);
    (upper, lower.with_min_y(upper.bottom() + gap))
}

/// Splits off the right part of this width; the rest ends before a gap.
pub(crate) fn before(rect: Rect, width: f32, gap: f32) -> (Rect, Rect) {
    let (left, right) = rect.split_left_right_at_x(rect.right() - width);
    (left.with_max_x(right.left() - gap), right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exhibit::plan::TILES;

    #[test]
    fn tiles_are_large_enough_for_a_finger_and_nothing_overlaps_at_any_size() {
        for (width, height) in [
            (1024.0, 640.0),
            (1280.0, 720.0),
            (1366.0, 768.0),
            (1440.0, 900.0),
            (1920.0, 1080.0),
            (3840.0, 2160.0),
            (2560.0, 1080.0),
            (1024.0, 1000.0),
            (1080.0, 1920.0),
            (720.0, 1280.0),
        ] {
            let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
            let places = PagePlaces::of(whole);
            for count in TILES {
                let tiles = places.tile_rects(count);
                assert_eq!(tiles.len(), count);
                let mut all = tiles.clone();
                all.extend([
                    places.title,
                    places.language,
                    places.lock,
                    places.hand,
                    places.words,
                    places.stop,
                ]);
                for tile in &tiles {
                    let size = tile.size();
                    assert!(
                        size.min_elem() >= TILE_LEAST,
                        "{count} at {width}x{height}: {size}"
                    );
                }
                for (index, one) in all.iter().enumerate() {
                    assert!(one.is_positive(), "{index} at {width}x{height}: {one}");
                    assert!(whole.contains_rect(*one));
                    let inside = one.shrink(0.5);
                    for other in all.iter().skip(index + 1) {
                        assert!(
                            !inside.intersects(other.shrink(0.5)),
                            "{count} at {width}x{height}: {one} {other}"
                        );
                    }
                }
            }
            for touched in [places.lock, places.language] {
                assert!(touched.size().min_elem() >= TOUCHED_LEAST);
            }
            assert!(!places.staff().intersects(places.stop));
            assert!(places.staff().height() >= 400.0, "{}", places.staff());
        }
    }
}
