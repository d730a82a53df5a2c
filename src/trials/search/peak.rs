//! What one close asked for, and the peak that it measured.

/// A speed and a threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Units of SPEED_SET.
    pub speed: f64,
    /// FORCE_SET, g.
    pub threshold_g: f64,
}

/// The peak of one close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenPeak {
    pub at: Contact,
    /// What the force sensor read at rest before it, g.
    pub offset_g: f64,
    /// Highest force above that, g.
    pub peak_g: f64,
    /// What it may have been more between two readings, g.
    pub missed_g: f64,
    /// Whether its readings were as near to each other as they usually are.
    pub is_certain: bool,
}

/// The peaks of closes, as they would be at one speed and threshold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CarriedPeaks {
    /// All of them, g.
    pub peaks_g: Vec<f64>,
    /// Those that were closed with it, g.
    pub here_g: Vec<f64>,
    /// How many of all are certain.
    pub certain: usize,
}
