//! What is read off a line: one value, or what many come to. Computed from what was measured, never from what is drawn.

/// One measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// When it was received, in seconds.
    pub time_s: f64,
    /// In the unit of the line.
    pub value: f32,
}

/// What the measurements of a stretch of time come to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Measurements with a known value, at least 1.
    pub count: u32,
    /// Smallest.
    pub min: f32,
    /// Largest.
    pub max: f32,
    /// Sum by count; each measurement counts once, however long it stood.
    pub mean: f64,
}
