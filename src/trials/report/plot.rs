//! Lines over time as an SVG picture for a static page. Knows no trial.

use crate::trials::measure::curve::TimeSeries;
use askama::Template;

/// Size of a picture and its margins, points.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 180.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 8.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 24.0;
/// Maximum number of points in a line: two per column, with more columns than pixels.
const POINTS_MAX: usize = 1280;
/// Number of stroke styles on a page.
pub(crate) const STROKES: usize = 6;

#[derive(Debug)]
struct ReportLine {
    stroke: usize,
    points: Vec<[f64; 2]>,
}

#[derive(Debug)]
struct PlotMark {
    at_s: f64,
    what: String,
}

#[derive(Debug, Template)]
#[template(
    path = "plot.svg",
    config = "trials/report/askama.toml",
    escape = "html"
)]
pub(crate) struct Plot {
    name: &'static str,
    from_s: f64,
    to_s: f64,
    lines: Vec<ReportLine>,
    level: Option<f64>,
    marks: Vec<PlotMark>,
    /// Lowest and highest value shown.
    extent: Option<(f64, f64)>,
}

impl Plot {
    /// An empty plot of a time range. `name` is the quantity with its unit.
    pub(crate) const fn new(name: &'static str, from_s: f64, to_s: f64) -> Self {
        Self {
            name,
            from_s,
            to_s,
            lines: Vec::new(),
            level: None,
            marks: Vec::new(),
            extent: None,
        }
    }

    /// Adds a line with one of the page's strokes, from 0.
    pub(crate) fn add(&mut self, stroke: usize, curve: &TimeSeries) {
        let points = curve.decimated(POINTS_MAX);
        for [_, value] in &points {
            self.include(*value);
        }
        let stroke = stroke % STROKES;
        self.lines.push(ReportLine { stroke, points });
    }

    /// Adds a horizontal reference line.
    pub(crate) fn set_level(&mut self, level: f64) {
        self.include(level);
        self.level = Some(level);
    }

    /// Adds a vertical mark.
    pub(crate) fn mark(&mut self, at_s: f64, what: String) {
        self.marks.push(PlotMark { at_s, what });
    }

    fn include(&mut self, value: f64) {
        let (low, high) = self.extent.unwrap_or((value, value));
        self.extent = Some((low.min(value), high.max(value)));
    }

    fn range(&self) -> (f64, f64) {
        self.extent.map_or((0.0, 1.0), |(low, high)| {
            let room = ((high - low) * 0.05).max(0.5);
            (low - room, high + room)
        })
    }

    fn x(&self, at_s: &f64) -> String {
        let span_s = (self.to_s - self.from_s).max(1e-3);
        let share = ((at_s - self.from_s) / span_s).clamp(0.0, 1.0);
        format!("{:.1}", LEFT + share * (WIDTH - LEFT - RIGHT))
    }

    fn y(&self, value: f64) -> String {
        let (low, high) = self.range();
        let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
        format!("{:.1}", HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM))
    }

    fn level_y(&self) -> Option<String> {
        self.level.map(|level| self.y(level))
    }

    fn path(&self, line: &ReportLine) -> String {
        let place = |[at_s, value]: &[f64; 2]| format!("{},{} ", self.x(at_s), self.y(*value));
        line.points.iter().map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_of_one_reading_among_many_is_drawn() {
        let curve: TimeSeries = (0..100_000)
            .map(|n| (f64::from(n) * 1e-4, if n == 54_321 { 999.0 } else { 0.0 }))
            .collect();
        let mut plot = Plot::new("Force, g", 0.0, 10.0);
        plot.add(0, &curve);
        let drawn = &plot.lines[0].points;
        assert!(drawn.len() <= POINTS_MAX);
        assert!(drawn.iter().any(|[_, v]| (*v - 999.0).abs() < 1e-9));
    }

    #[test]
    fn text_cannot_leave_its_place() {
        let mut plot = Plot::new("<b>", 0.0, 0.0);
        plot.mark(f64::NAN, "\"><x>".into());
        let svg = plot.render().unwrap();
        assert!(!svg.contains("<b>") && !svg.contains("<x>"), "{svg}");
    }
}
