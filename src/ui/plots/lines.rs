//! The lines of one plot: fetched from the history and drawn. Knows no scale of its own and no pointer.

use crate::history::{History, Trace};
use crate::ui::plots::axes::{Extent, Placing};
use crate::ui::plots::bars as plot_bars;
use crate::ui::plots::ends::End;
use crate::ui::plots::plot_rows::PlotLine;
use crate::ui::plots::sight::Span;
use crate::ui::theme::{self, Palette};
use egui::{Mesh, Painter, Stroke};

/// What was asked for is paler than what was measured.
const WISHED_PART: f32 = 0.45;

/// Lines with their points. Kept from frame to frame: of a line that goes on only the newest is fetched.
#[derive(Debug, Default)]
pub(crate) struct PlotLines {
    used: usize,
    pool: Vec<(Option<PlotLine>, Trace)>,
    columns: usize,
    /// What the values span.
    pub(crate) extent: Extent,
    /// True if a measured line has points that stand for several.
    pub(crate) decimated: bool,
}

impl PlotLines {
    /// Fetches lines, with as many points as the plot has columns of pixels.
    pub(crate) fn gather(
        &mut self,
        history: &History,
        lines: &[PlotLine],
        span: Span,
        columns: usize,
    ) {
        (self.used, self.columns) = (lines.len(), columns);
        (self.extent, self.decimated) = (Extent::default(), false);
        if self.pool.len() < lines.len() {
            self.pool.resize_with(lines.len(), Default::default);
        }
        for (line, (of, trace)) in lines.iter().zip(&mut self.pool) {
            *of = Some(*line);
            history.trace(line.series, span.0, span.1, columns, trace);
            self.decimated |= trace.decimated && !line.wished;
            let ends = trace.points().fold(None, |ends, [_, value]| {
                let (low, high): (f64, f64) = ends.unwrap_or((value, value));
                Some((low.min(value), high.max(value)))
            });
            if let Some((low, high)) = ends {
                self.extent.include(low);
                self.extent.include(high);
            }
        }
    }

    /// True if there is nothing to draw.
    pub(crate) fn is_empty(&self) -> bool {
        self.iter().all(|(_, trace)| trace.segments.is_empty())
    }

    /// Where the measured lines end.
    pub(crate) fn ends(&self, placing: Placing) -> Vec<End> {
        let measured = self.iter().filter(|(line, _)| !line.wished);
        let ends = measured.filter_map(|(line, trace)| {
            let last = trace.segments.last()?.last()?;
            let y = placing.at(last).y;
            Some(End { line, y })
        });
        ends.collect()
    }

    /// Draws them.
    pub(crate) fn ui(&self, painter: &Painter, placing: Placing, palette: &Palette) {
        let mut mesh = Mesh::default();
        for (line, trace) in self.iter() {
            let color = palette.dof[line.dof];
            let stroke = if line.wished {
                Stroke::new(1.0, color.gamma_multiply(WISHED_PART))
            } else {
                Stroke::new(theme::LINE, color)
            };
            let points: usize = trace.segments.iter().map(Vec::len).sum();
            let dense = trace.decimated || points > self.columns;
            for segment in &trace.segments {
                let places = segment.iter().map(|point| placing.at(point));
                match segment.as_slice() {
                    // A line of one point has no length: what was measured alone is a dot.
                    [alone] => {
                        painter.circle_filled(placing.at(alone), stroke.width, stroke.color);
                    }
                    _ if dense => plot_bars::add(&mut mesh, stroke, places),
                    many if line.wished => {
                        let steps = steps(many).map(|point| placing.at(&point));
                        painter.line(steps.collect(), stroke);
                    }
                    _ => {
                        painter.line(places.collect(), stroke);
                    }
                }
            }
        }
        painter.add(mesh);
    }

    fn iter(&self) -> impl Iterator<Item = (PlotLine, &Trace)> {
        let used = self.pool.iter().take(self.used);
        used.filter_map(|(line, trace)| Some(((*line)?, trace)))
    }
}

/// A value that was asked for stands until the next one: nothing asked a hand for what lies between.
fn steps(points: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> {
    let mut before: Option<f64> = None;
    points.iter().flat_map(move |[time_s, value]| {
        let corner = before.replace(*value).map(|before| [*time_s, before]);
        corner.into_iter().chain([[*time_s, *value]])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_asked_for_stands_until_the_next() {
        let seen: Vec<_> = steps(&[[0.0, 1.0], [2.0, 5.0]]).collect();
        assert_eq!(seen, [[0.0, 1.0], [2.0, 1.0], [2.0, 5.0]]);
    }
}
