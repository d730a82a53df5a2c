//! Readouts of a line: a single value or a summary. Computed from the measurements, never from the drawn points.

/// One measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Time of receipt, in seconds.
    pub time_s: f64,
    /// In the line's unit.
    pub value: f32,
}

/// Summary of the measurements in a time range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Number of measurements with a known value, at least 1.
    pub count: u32,
    pub min: f32,
    pub max: f32,
    /// Sum divided by count; each measurement counts once, regardless of its duration.
    pub mean: f64,
}
