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

/// Mean and noise of a stretch of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Mean, in the line's unit.
    pub mean: f64,
    /// Standard deviation of the sample, in the same unit.
    pub deviation: f64,
}

impl Spread {
    /// Of some values; `None` below two. In one pass and without losing digits to large means (Welford).
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let (mut count, mut mean, mut squares) = (0u32, 0.0, 0.0);
        for value in values {
            count += 1;
            let apart = value - mean;
            mean += apart / f64::from(count);
            squares += apart * (value - mean);
        }
        (count >= 2).then(|| Self {
            mean,
            deviation: (squares / f64::from(count - 1)).sqrt(),
        })
    }
}
