//! Peak force of each joint over the last seconds: a moving bar is too fast to read.

use crate::hand::{HandSample, Moment, PerDof};
use std::time::Duration;

/// Time for which a peak is held.
pub const PEAK_HOLD: Duration = Duration::from_secs(3);

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ForcePeaks(PerDof<Option<(i16, Moment)>>);

impl ForcePeaks {
    /// Peak force of this joint in g and its time; `None` before the first reading.
    pub fn get(&self, dof: crate::hand::Dof) -> Option<(i16, Moment)> {
        self.0[dof]
    }

    /// Applies a new force reading. Undocumented values are ignored.
    pub(crate) fn update(&mut self, sample: &HandSample) {
        let Some(force) = sample.force else { return };
        for (dof, peak) in self.0.iter_mut() {
            let Some(grams) = force.value[dof].documented() else {
                continue;
            };
            let beaten = peak.is_none_or(|(highest, at)| {
                grams >= highest || force.received.since(at) >= PEAK_HOLD
            });
            if beaten {
                *peak = Some((grams, force.received));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Dof, ForceReading, Timed};

    fn reading(grams: i16, millis: u64) -> HandSample {
        let at = Moment::from_micros(millis * 1000);
        HandSample {
            force: Some(Timed {
                value: PerDof::splat(ForceReading::new(grams)),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        }
    }

    #[test]
    fn a_peak_stays_three_seconds_and_gives_way_to_a_higher_one() {
        let mut peaks = ForcePeaks::default();
        let mut after = |grams, millis| {
            peaks.update(&reading(grams, millis));
            peaks.get(Dof::Index).map(|(grams, _)| grams)
        };
        assert_eq!(after(100, 0), Some(100));
        assert_eq!(after(900, 100), Some(900));
        assert_eq!(after(200, 200), Some(900));
        assert_eq!(after(950, 300), Some(950));
        assert_eq!(after(10, 3299), Some(950));
        assert_eq!(after(20, 3300), Some(20));
        assert_eq!(after(32767, 3400), Some(20), "not documented");
    }
}
