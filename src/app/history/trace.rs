//! Lines that are ready to draw. How they are made is told elsewhere.

/// The lines of one quantity. Kept by the view and filled again each frame, so that nothing is allocated.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// Unbroken lines of (seconds, value), oldest first. None is empty.
    pub segments: Vec<Vec<[f64; 2]>>,
    /// True if each point stands for several measurements: smallest and largest of a column of pixels.
    pub decimated: bool,
    /// How the rows were cut into columns of pixels. Lines that were read together share it.
    pub(crate) cut: Cut,
    spare: Vec<Vec<[f64; 2]>>,
    open: bool,
}

/// Rows cut into columns of pixels.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Cut {
    /// What was cut, and how.
    pub(crate) key: Option<CutKey>,
    /// The columns, oldest first.
    pub(crate) stretches: Vec<Stretch>,
}

/// What makes two cuts equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CutKey {
    /// Which row of times.
    pub(crate) track: u8,
    /// Its length when it was cut.
    pub(crate) end: usize,
    /// From, in seconds.
    pub(crate) from_s: f64,
    /// To, in seconds.
    pub(crate) to_s: f64,
    /// Columns of pixels.
    pub(crate) columns: u32,
}

/// The rows of one column of pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    /// First row.
    pub(crate) start: usize,
    /// After the last row.
    pub(crate) end: usize,
    /// Time of the first row.
    pub(crate) first_s: f64,
    /// Time of the row in the middle.
    pub(crate) middle_s: f64,
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

    /// All points of all lines.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.segments.iter().flatten().copied()
    }
}
