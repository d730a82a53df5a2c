//! Lines that are ready to draw. [`crate::history::track`] makes them.

use crate::history::grid::Grid;

/// The lines of one quantity. The view reuses it each frame, so that nothing is allocated; reuse for the same series is faster,
/// as only the newest pixel columns are computed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// Unbroken lines of (seconds, value), oldest first, never empty.
    pub segments: Vec<Vec<[f64; 2]>>,
    /// True if points are decimated: the minimum and maximum of each pixel column.
    pub decimated: bool,
    /// Pixel columns cached for the next frame.
    pub(crate) grid: Grid,
    spare: Vec<Vec<[f64; 2]>>,
    open: bool,
}

impl Trace {
    /// Clears the lines, but retains their memory.
    pub(crate) fn begin(&mut self) {
        for mut segment in self.segments.drain(..) {
            segment.clear();
            self.spare.push(segment);
        }
        self.decimated = false;
        self.open = false;
    }

    /// Adds a point to the current line.
    pub(crate) fn point(&mut self, time_s: f64, value: f32) {
        if !self.open {
            self.segments.push(self.spare.pop().unwrap_or_default());
            self.open = true;
        }
        if let Some(segment) = self.segments.last_mut() {
            segment.push([time_s, f64::from(value)]);
        }
    }

    /// Ends the current line.
    pub(crate) const fn end(&mut self) {
        self.open = false;
    }

    /// Extends the last value to `time_s`.
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
