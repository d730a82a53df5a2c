//! Lines over time as a picture in SVG, for a page that is read without a program. Knows no trial.

use crate::app::trial::curve::Curve;
use std::fmt::Write as _;

/// Size of a picture and of the room around the lines, points.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 180.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 8.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 24.0;
/// A line is drawn with so many pieces, each by its lowest and highest value: more than there are pixels.
const PIECES: u32 = 640;

/// One line.
#[derive(Debug)]
pub(crate) struct Line {
    /// Its place in the page's order of strokes, 0 the first.
    pub(crate) stroke: usize,
    pub(crate) curve: Curve,
}

/// A picture.
#[derive(Debug)]
pub(crate) struct Plot {
    /// What it shows, with its unit.
    pub(crate) name: String,
    pub(crate) from_s: f64,
    pub(crate) to_s: f64,
    pub(crate) lines: Vec<Line>,
    /// A level to compare with.
    pub(crate) level: Option<f64>,
    /// Times and names of what happened.
    pub(crate) marks: Vec<(f64, String)>,
}

/// Text that is safe between tags and in attributes.
#[must_use]
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // No control sign but the break of lines has a place in a page.
            other if other.is_control() && other != '\n' => out.push('\u{FFFD}'),
            other => out.push(other),
        }
    }
    out
}

impl Plot {
    /// The picture.
    #[must_use]
    pub(crate) fn svg(&self) -> String {
        let (low, high) = self.range();
        let place = Place {
            from_s: self.from_s,
            to_s: self.to_s.max(self.from_s + 1e-3),
            low,
            high,
        };
        let name = escaped(&self.name);
        let mut out = format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{name}\"><title>{name}</title>"
        );
        place.frame(&mut out, &name);
        for (at, what) in &self.marks {
            let x = place.x(*at);
            let (what, bottom) = (escaped(what), HEIGHT - BOTTOM);
            // Writing to a string cannot fail.
            let _done = write!(
                out,
                "<line class=\"mark\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{bottom}\"><title>{what}</title></line>"
            );
        }
        if let Some(level) = self.level {
            let (y, right) = (place.y(level), WIDTH - RIGHT);
            let _done = write!(
                out,
                "<line class=\"level\" x1=\"{LEFT}\" x2=\"{right}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>"
            );
        }
        for line in &self.lines {
            let stroke = line.stroke % 6;
            let _done = write!(out, "<polyline class=\"s{stroke}\" points=\"");
            for (t, v) in place.thinned(&line.curve) {
                let _done = write!(out, "{:.1},{:.1} ", place.x(t), place.y(v));
            }
            out.push_str("\"/>");
        }
        out.push_str("</svg>\n");
        out
    }

    fn range(&self) -> (f64, f64) {
        let points = self.lines.iter().flat_map(|line| line.curve.points());
        let values = points.map(|point| point.v).chain(self.level);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        if low > high {
            return (0.0, 1.0);
        }
        let room = ((high - low) * 0.05).max(0.5);
        (low - room, high + room)
    }
}

/// Where values stand in a picture.
struct Place {
    from_s: f64,
    to_s: f64,
    low: f64,
    high: f64,
}

impl Place {
    fn x(&self, t: f64) -> f64 {
        let share = ((t - self.from_s) / (self.to_s - self.from_s)).clamp(0.0, 1.0);
        LEFT + share * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, v: f64) -> f64 {
        let share = ((v - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)
    }

    fn frame(&self, out: &mut String, name: &str) {
        let (width, height) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
        let (left, bottom, foot) = (LEFT - 4.0, HEIGHT - BOTTOM, HEIGHT - 8.0);
        let (high_y, right) = (TOP + 10.0, WIDTH - RIGHT);
        let _done = write!(
            out,
            "<rect class=\"frame\" x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\"/>\
             <text class=\"end\" x=\"{left}\" y=\"{high_y}\">{:.0}</text>\
             <text class=\"end\" x=\"{left}\" y=\"{bottom}\">{:.0}</text>\
             <text x=\"{LEFT}\" y=\"{foot}\">{:.2} s</text>\
             <text class=\"end\" x=\"{right}\" y=\"{foot}\">{:.2} s</text>\
             <text class=\"middle\" x=\"{}\" y=\"{foot}\">{name}</text>",
            self.high,
            self.low,
            self.from_s,
            self.to_s,
            WIDTH / 2.0,
        );
    }

    /// The lowest and highest value of each piece of time, in their order, so that no peak is lost.
    fn thinned(&self, curve: &Curve) -> Vec<(f64, f64)> {
        let step = (self.to_s - self.from_s) / f64::from(PIECES);
        let mut out: Vec<(f64, f64)> = Vec::new();
        for piece in 0..PIECES {
            let from = self.from_s + f64::from(piece) * step;
            let to = from + step;
            let inside = || {
                let start = curve.points().partition_point(|point| point.t < from);
                let rest = curve.points().get(start..).unwrap_or_default();
                rest.iter().take_while(move |point| point.t < to)
            };
            let low = inside().min_by(|a, b| a.v.total_cmp(&b.v));
            let high = inside().max_by(|a, b| a.v.total_cmp(&b.v));
            let (Some(low), Some(high)) = (low, high) else {
                continue;
            };
            let mut pair = [(low.t, low.v), (high.t, high.v)];
            pair.sort_by(|a, b| a.0.total_cmp(&b.0));
            let [first, second] = pair;
            out.push(first);
            if second != first {
                out.push(second);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_of_one_reading_among_many_is_drawn() {
        let curve: Curve = (0..100_000)
            .map(|n| (f64::from(n) * 1e-4, if n == 54_321 { 999.0 } else { 0.0 }))
            .collect();
        let place = Place {
            from_s: 0.0,
            to_s: 10.0,
            low: 0.0,
            high: 1000.0,
        };
        let drawn = place.thinned(&curve);
        assert!(drawn.len() <= 2 * 640);
        assert!(drawn.iter().any(|(_, v)| (*v - 999.0).abs() < 1e-9));
    }

    #[test]
    fn text_cannot_leave_its_place() {
        let text = escaped("</svg><script>alert(\"1\")</script>&'\u{1b}");
        assert!(!text.contains(['<', '>', '"', '\'', '\u{1b}']), "{text}");
        let plot = Plot {
            name: "<b>".into(),
            from_s: 0.0,
            to_s: 0.0,
            lines: Vec::new(),
            level: None,
            marks: vec![(f64::NAN, "\"><x>".into())],
        };
        let svg = plot.svg();
        assert!(!svg.contains("<b>") && !svg.contains("<x>"), "{svg}");
    }
}
