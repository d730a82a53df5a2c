//! Lines with more points than pixels, as one upright bar a pixel: what such a line covers anyway, and far cheaper than
//! a path whose every corner is cut and smoothed. Knows no hand and no time.

use egui::{Color32, Mesh, Pos2, Rect, Stroke, pos2};

/// Points this far apart are joined by a slope, not by bars.
const JOINED: f32 = 2.0;

/// What a line covers in one column of pixels.
#[derive(Debug, Clone, Copy)]
struct Bar {
    x: f32,
    top: f32,
    bottom: f32,
}

/// Adds a line of many points to a mesh.
pub(crate) fn add(mesh: &mut Mesh, stroke: Stroke, points: impl Iterator<Item = Pos2>) {
    let mut bar: Option<Bar> = None;
    let mut before: Option<Pos2> = None;
    for point in points {
        let far = before.filter(|before| point.x - before.x > JOINED);
        if let Some(before) = far {
            slope(mesh, stroke, before, point);
        }
        // A bar begins where the one before it ended, so that the line has no holes.
        let from_y = before
            .filter(|_| far.is_none())
            .map_or(point.y, |before| before.y);
        bar = Some(match bar {
            Some(bar) if bar.x == point.x.floor() => Bar {
                top: bar.top.min(point.y),
                bottom: bar.bottom.max(point.y),
                ..bar
            },
            done => {
                finish(mesh, stroke, done);
                Bar {
                    x: point.x.floor(),
                    top: point.y.min(from_y),
                    bottom: point.y.max(from_y),
                }
            }
        });
        before = Some(point);
    }
    finish(mesh, stroke, bar);
}

fn finish(mesh: &mut Mesh, stroke: Stroke, bar: Option<Bar>) {
    if let Some(bar) = bar {
        let half = stroke.width / 2.0;
        let rect = Rect::from_min_max(
            pos2(bar.x + 0.5 - half, bar.top - half),
            pos2(bar.x + 0.5 + half, bar.bottom + half),
        );
        mesh.add_colored_rect(rect, stroke.color);
    }
}

fn slope(mesh: &mut Mesh, stroke: Stroke, from: Pos2, to: Pos2) {
    let aside = (to - from).rot90().normalized() * (stroke.width / 2.0);
    quad(
        mesh,
        stroke.color,
        [from - aside, from + aside, to + aside, to - aside],
    );
}

fn quad(mesh: &mut Mesh, color: Color32, corners: [Pos2; 4]) {
    let Ok(first) = u32::try_from(mesh.vertices.len()) else {
        return;
    };
    for corner in corners {
        mesh.colored_vertex(corner, color);
    }
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first, first + 2, first + 3);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(points: &[(f32, f32)]) -> (Mesh, Rect) {
        let mut mesh = Mesh::default();
        let points = points.iter().map(|(x, y)| pos2(*x, *y));
        add(&mut mesh, Stroke::new(1.0, Color32::PLACEHOLDER), points);
        let bounds = mesh.calc_bounds();
        (mesh, bounds)
    }

    #[test]
    fn a_spike_keeps_its_whole_height_and_costs_one_bar_a_pixel() {
        let line: Vec<(f32, f32)> = (0..4000_u16)
            .map(|n| {
                let y = if n == 1234 { 5.0 } else { 90.0 };
                (f32::from(n) / 8.0, y)
            })
            .collect();
        let (mesh, bounds) = covered(&line);
        assert_eq!(mesh.vertices.len(), 500 * 4);
        assert!((bounds.top() - 4.5).abs() < 1e-3 && (bounds.bottom() - 90.5).abs() < 1e-3);
    }

    #[test]
    fn neighbouring_bars_touch_and_far_points_are_joined_by_a_slope() {
        let (mesh, _) = covered(&[(0.2, 10.0), (1.2, 50.0), (9.0, 50.0)]);
        assert_eq!(mesh.vertices.len(), 4 * 4, "three bars and a slope");
        // The slope goes in before the bar that it leaves.
        let second = mesh.vertices.get(8..12).unwrap_or_default();
        let top = second
            .iter()
            .map(|corner| corner.pos.y)
            .fold(f32::MAX, f32::min);
        assert!((top - 9.5).abs() < 1e-3, "{top}");
    }
}
