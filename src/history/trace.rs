//! Lines that are ready to draw. How they are made is told elsewhere.

use crate::history::grid::Grid;

/// The lines of one quantity. Kept by the view and filled again each frame, so that nothing is allocated; one that is
/// kept for the same series is filled faster, as only its newest columns of pixels are new.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// Unbroken lines of (seconds, value), oldest first. None is empty.
    pub segments: Vec<Vec<[f64; 2]>>,
    /// True if each point stands for several measurements: smallest and largest of a column of pixels.
    pub decimated: bool,
    /// Columns of pixels that are kept for the next time.
    pub(crate) grid: Grid,
    spare: Vec<Vec<[f64; 2]>>,
    open: bool,
}

impl Trace {
    /// Empties it and keeps its memory.
    pub(crate) fn begin(&mut self) {
        for mut segment in self.segments.drain(..) {
            segment.clear();
            self.spare.push(segment);
        }
        self.decimated = false;
        self.open = false;
    }

    /// Adds a point to the line that is being drawn.
    pub(crate) fn point(&mut self, time_s: f64, value: f32) {
        if !self.open {
            self.segments.push(self.spare.pop().unwrap_or_default());
            self.open = true;
        }
        if let Some(segment) = self.segments.last_mut() {
            segment.push([time_s, f64::from(value)]);
        }
    }

    /// Ends the line that is being drawn.
    pub(crate) const fn end(&mut self) {
        self.open = false;
    }

    /// Lets the last value stand until a time.
    pub fn hold_until(&mut self, time_s: f64) {
        let last = self.segments.last_mut();
        if let Some((segment, [last_s, value])) =
            last.and_then(|segment| segment.last().copied().map(|point| (segment, point)))
            && last_s < time_s
        {
            segment.push([time_s, value]);
        }
    }

    /// All points of all lines.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.segments.iter().flatten().copied()
    }
}
