//! The reference of a drive's force threshold: the sensor reading, or the reading above rest. The manual states the
//! first (2.6.12); a peak below the threshold of one of them excludes it. Pure.

use crate::trials::search::peak::SeenPeak;
use serde::Serialize;

/// A peak is distinct from a threshold beyond this many times the noise plus some grams.
const DISTINCT_SIGMAS: f64 = 4.0;
const DISTINCT_MORE_G: f64 = 3.0;
/// A reference is excluded if more than this share of the closes contradict it.
const AGAINST_MOST: f64 = 0.25;

/// The reference of a drive's force threshold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum ThresholdReference {
    /// FORCE_ACT as read, including the sensor's offset (manual 2.6.12).
    #[default]
    AsRead,
    /// The force above the reading at rest.
    AboveRest,
    /// Something else: it stops below both.
    Unknown,
}

impl ThresholdReference {
    /// All, the manual's first.
    pub const ALL: [Self; 3] = [Self::AsRead, Self::AboveRest, Self::Unknown];

    /// The force above rest at which a threshold stops the drive, g; 0 if unknown, so that the whole peak counts as overshoot.
    pub fn stops_at(self, threshold_g: f64, offset_g: f64) -> f64 {
        match self {
            Self::AsRead => (threshold_g - offset_g).max(0.0),
            Self::AboveRest => threshold_g,
            Self::Unknown => 0.0,
        }
    }

    /// The same for a recorded close.
    pub(crate) fn stops_at_in(self, seen: &SeenPeak) -> f64 {
        self.stops_at(seen.at.threshold_g, seen.offset_g)
    }

    /// Overshoot of a recorded close, g.
    pub(crate) fn over_g(self, seen: &SeenPeak) -> f64 {
        seen.peak_g - self.stops_at_in(seen)
    }

    /// True if a peak is lower than this reference allows.
    pub(crate) fn is_contradicted_by(self, seen: &SeenPeak, noise_g: f64) -> bool {
        self.over_g(seen) < -distinct_from_g(noise_g) - seen.missed_g
    }

    /// The threshold that stops the drive at this force above rest, g.
    pub(crate) fn threshold_for(self, force_g: f64, offset_g: f64) -> f64 {
        match self {
            Self::AsRead => force_g + offset_g,
            Self::AboveRest | Self::Unknown => force_g,
        }
    }
}

/// Smallest difference that is distinct from noise, g.
pub(crate) fn distinct_from_g(noise_g: f64) -> f64 {
    DISTINCT_SIGMAS * noise_g + DISTINCT_MORE_G
}

/// Evidence about the reference of a drive, from the closes of its joint.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OffsetEvidence {
    closes: f64,
    against_as_read: f64,
    against_above_rest: f64,
    in_air: bool,
    offset_g: f64,
}

impl OffsetEvidence {
    pub(crate) fn add(&mut self, seen: &SeenPeak, noise_g: f64) {
        let against =
            |compared: ThresholdReference| f64::from(compared.is_contradicted_by(seen, noise_g));
        self.closes += 1.0;
        self.against_as_read += against(ThresholdReference::AsRead);
        self.against_above_rest += against(ThresholdReference::AboveRest);
        self.offset_g = seen.offset_g;
    }

    pub(crate) const fn stopped_in_air(&mut self, offset_g: f64) {
        self.in_air = true;
        self.offset_g = offset_g;
    }

    pub(crate) const fn offset_g(&self) -> f64 {
        self.offset_g
    }

    fn is_against(&self, against: f64) -> bool {
        against > AGAINST_MOST * self.closes
    }

    /// The references that are still possible.
    pub(crate) fn possible(&self) -> Vec<ThresholdReference> {
        let as_read = !self.is_against(self.against_as_read);
        let above_rest = !self.in_air && !self.is_against(self.against_above_rest);
        match (as_read, above_rest) {
            (true, true) => vec![ThresholdReference::AsRead, ThresholdReference::AboveRest],
            (true, false) => vec![ThresholdReference::AsRead],
            (false, true) => vec![ThresholdReference::AboveRest],
            (false, false) => vec![ThresholdReference::Unknown],
        }
    }

    /// The reference, if the evidence leaves only one.
    pub(crate) fn reference(&self) -> Option<ThresholdReference> {
        match self.possible().as_slice() {
            [ThresholdReference::Unknown] => None,
            [one] => Some(*one),
            _ => None,
        }
    }
}
