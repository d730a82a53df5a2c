//! The setting of one close, and its measured peak.

/// A speed and a threshold at the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSetting {
    /// Units of SPEED_SET.
    pub speed: f64,
    /// FORCE_SET, g.
    pub threshold_g: f64,
}

/// The peak of one close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenPeak {
    pub at: ContactSetting,
    /// Reading of the force sensor at rest before it, g.
    pub offset_g: f64,
    /// Highest force above that reading, g.
    pub peak_g: f64,
    /// Possible extra height between two readings, g.
    pub missed_g: f64,
    /// True unless its readings may have missed the top.
    pub is_certain: bool,
}

/// Peaks of closes, scaled to one speed and threshold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CarriedPeaks {
    /// All of them, g.
    pub peaks_g: Vec<f64>,
    /// Those of closes made at this setting, g.
    pub here_g: Vec<f64>,
    /// Number of certain ones among all.
    pub certain: usize,
}
