//! Plot lines with more points than pixels, drawn as vertical bars of one pixel each: they cover the same area as such a line,
//! and are far cheaper than a path with every corner mitred and smoothed. Each spike is a whole pixel wide, where the bands of
//! `egui_plot` would thin it. Independent of the hand and of time.

use egui::epaint::{Vertex, WHITE_UV};
use egui::{Color32, Mesh, Pos2, Stroke, pos2};

/// Points farther apart than this, in pixels, are joined by a slope instead of bars.
const JOINED_PX: f32 = 2.0;
/// Width over which the upper and lower edges fade, in points.
const FADE_PX: f32 = 1.0;
/// Bars whose ends differ by less are merged: a sixteenth of a point is invisible.
const SAME_PX: f32 = 1.0 / 16.0;
/// Maximum ratio of a slope's vertical to its perpendicular thickness.
const STEEP_MOST_RATIO: f32 = 4.0;

/// Area that a line covers in adjacent pixel columns.
#[derive(Debug, Clone, Copy)]
struct PixelBar {
    x: f32,
    end: f32,
    top: f32,
    bottom: f32,
}

impl PixelBar {
    fn alike(self, other: Self) -> bool {
        self.end == other.x
            && (self.top - other.top).abs() < SAME_PX
            && (self.bottom - other.bottom).abs() < SAME_PX
    }
}

/// Adds a line of many points to a mesh; a bar is one pixel wide, in points.
pub fn add(mesh: &mut Mesh, stroke: Stroke, pixel: f32, points: impl Iterator<Item = Pos2>) {
    let mut wide: Option<PixelBar> = None;
    let mut bar: Option<PixelBar> = None;
    let mut before: Option<Pos2> = None;
    for point in points {
        let x = (point.x / pixel).floor() * pixel;
        if let Some(bar) = bar.as_mut().filter(|bar| bar.x == x) {
            bar.top = bar.top.min(point.y);
            bar.bottom = bar.bottom.max(point.y);
            before = Some(point);
            continue;
        }
        finish(mesh, stroke, &mut wide, bar);
        let far = before.filter(|before| point.x - before.x > JOINED_PX * pixel);
        if let Some(before) = far {
            slope(mesh, stroke, before, point);
        }
        // A bar begins where the previous one ended, so that the line has no gaps.
        let near = before.filter(|_| far.is_none());
        let from_y = near.map_or(point.y, |before| before.y);
        bar = Some(PixelBar {
            // If a pixel column is skipped, this bar covers both.
            x: bar
                .filter(|_| near.is_some())
                .map_or(x, |bar| bar.end.min(x)),
            end: x + pixel,
            top: point.y.min(from_y),
            bottom: point.y.max(from_y),
        });
        before = Some(point);
    }
    finish(mesh, stroke, &mut wide, bar);
    if let Some(wide) = wide {
        paint(mesh, stroke, wide);
    }
}

/// Merges a bar into the pending one if they are alike, else paints the pending one.
fn finish(mesh: &mut Mesh, stroke: Stroke, wide: &mut Option<PixelBar>, bar: Option<PixelBar>) {
    let Some(bar) = bar else { return };
    match wide {
        Some(wide) if wide.alike(bar) => wide.end = bar.end,
        _ => {
            if let Some(done) = wide.replace(bar) {
                paint(mesh, stroke, done);
            }
        }
    }
}

fn paint(mesh: &mut Mesh, stroke: Stroke, bar: PixelBar) {
    let out = (stroke.width + FADE_PX) / 2.0;
    let core = (stroke.width - FADE_PX).max(0.0) / 2.0;
    let (top, bottom) = (bar.top - core, bar.bottom + core);
    let outer = (bar.top - out, bar.bottom + out);
    let clear = Color32::TRANSPARENT;
    let levels = [
        (outer.0, clear),
        (top, stroke.color),
        (bottom, stroke.color),
        (outer.1, clear),
    ];
    strip(mesh, [bar.x, bar.end], [levels, levels]);
}

fn slope(mesh: &mut Mesh, stroke: Stroke, from: Pos2, to: Pos2) {
    let steep = ((to.y - from.y) / (to.x - from.x).max(JOINED_PX)).hypot(1.0);
    let out = (stroke.width + FADE_PX) / 2.0 * steep.min(STEEP_MOST_RATIO);
    let core = (stroke.width - FADE_PX).max(0.0) / 2.0 * steep.min(STEEP_MOST_RATIO);
    let clear = Color32::TRANSPARENT;
    let levels = |y: f32| {
        [
            (y - out, clear),
            (y - core, stroke.color),
            (y + core, stroke.color),
            (y + out, clear),
        ]
    };
    strip(mesh, [from.x, to.x], [levels(from.y), levels(to.y)]);
}

/// Two columns of equally many heights, joined by a band between each pair.
fn strip(mesh: &mut Mesh, x: [f32; 2], heights: [[(f32, Color32); 4]; 2]) {
    let Ok(first) = u32::try_from(mesh.vertices.len()) else {
        return;
    };
    for (x, heights) in x.into_iter().zip(heights) {
        mesh.vertices.extend(heights.map(|(y, color)| Vertex {
            pos: pos2(x, y),
            uv: WHITE_UV,
            color,
        }));
    }
    for left in first..first + 3 {
        let right = left + 4;
        mesh.indices
            .extend([left, left + 1, right, right, left + 1, right + 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Rect;

    const STROKE: Stroke = Stroke {
        width: 1.0,
        color: Color32::PLACEHOLDER,
    };

    fn covered(points: &[(f32, f32)]) -> (Mesh, Rect) {
        let mut mesh = Mesh::default();
        let points = points.iter().map(|(x, y)| pos2(*x, *y));
        add(&mut mesh, STROKE, 1.0, points);
        let bounds = mesh.calc_bounds();
        assert!(mesh.is_valid());
        (mesh, bounds)
    }

    /// Heights at which a column of pixels is solid.
    fn solid(mesh: &Mesh, x: f32) -> Option<(f32, f32)> {
        let wide = |corners: &&&[Vertex]| {
            let (left, right) = corners.split_at(corners.len() / 2);
            left.iter().all(|one| one.pos.x <= x) && right.iter().all(|one| one.pos.x >= x)
        };
        let all: Vec<&[Vertex]> = mesh.vertices.chunks(8).collect();
        let solid = all.iter().filter(wide).flat_map(|corners| corners.iter());
        let heights = solid.filter(|one| one.color != Color32::TRANSPARENT);
        heights.map(|one| one.pos.y).fold(None, |all, y| {
            let (top, bottom) = all.unwrap_or((y, y));
            Some((y.min(top), y.max(bottom)))
        })
    }

    #[test]
    fn a_spike_keeps_its_whole_height_over_a_whole_pixel() {
        let line: Vec<(f32, f32)> = (0..4000_u16)
            .map(|n| {
                let y = if n == 1234 { 5.0 } else { 90.0 };
                (f32::from(n) / 8.0, y)
            })
            .collect();
        let (mesh, bounds) = covered(&line);
        assert_eq!(solid(&mesh, 154.5), Some((5.0, 90.0)));
        assert_eq!(solid(&mesh, 150.5), Some((90.0, 90.0)));
        assert!((bounds.top() - 4.0).abs() < 1e-3 && (bounds.bottom() - 91.0).abs() < 1e-3);
        // What is alike is one bar.
        assert_eq!(mesh.vertices.len(), 3 * 8);
    }

    #[test]
    fn a_line_that_never_rests_costs_one_bar_a_pixel() {
        let line: Vec<(f32, f32)> = (0..4000_u16)
            .map(|n| (f32::from(n) / 8.0, f32::from(n % 101 * 37 % 101)))
            .collect();
        let (mesh, _) = covered(&line);
        assert!(mesh.vertices.len() <= 500 * 8);
    }

    #[test]
    fn neighbouring_bars_touch_and_far_points_are_joined_by_a_slope() {
        let (mesh, _) = covered(&[(0.2, 10.0), (1.2, 50.0), (9.0, 70.0)]);
        assert_eq!(solid(&mesh, 0.5), Some((10.0, 10.0)));
        assert_eq!(solid(&mesh, 1.1), Some((10.0, 50.0)));
        assert_eq!(solid(&mesh, 5.0), Some((50.0, 70.0)));
        assert_eq!(solid(&mesh, 9.5), Some((70.0, 70.0)));
    }

    #[test]
    fn a_column_of_pixels_without_a_point_is_no_hole() {
        let (mesh, _) = covered(&[(0.9, 10.0), (2.1, 30.0)]);
        assert_eq!(solid(&mesh, 1.5), Some((10.0, 30.0)));
    }
}
