//! How often something is read on this wire, and so from when on it is old: whoever missed about three readings is.

use crate::hand::Moment;
use std::time::Duration;

/// Nothing is old sooner.
pub const STALE_AFTER_LEAST: Duration = Duration::from_millis(250);
/// Everything is old then.
pub const STALE_AFTER_MOST: Duration = Duration::from_secs(3);
/// Readings that may be missed.
const MISSED: u32 = 3;
/// Intervals that are looked at.
const INTERVALS: usize = 4;

/// The last intervals between readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadingPace {
    last: Option<Moment>,
    intervals: [Duration; INTERVALS],
}

impl ReadingPace {
    /// Something was asked for at this moment, and came.
    pub fn take(&mut self, asked: Moment) {
        if let Some(last) = self.last.replace(asked) {
            self.intervals.rotate_left(1);
            if let Some(newest) = self.intervals.last_mut() {
                *newest = asked.since(last);
            }
        }
    }

    /// From which age on it is old.
    pub fn stale_after(&self) -> Duration {
        let longest = self.intervals.iter().max().copied().unwrap_or_default();
        (longest * MISSED).clamp(STALE_AFTER_LEAST, STALE_AFTER_MOST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_is_what_missed_about_three_readings() {
        let at = |ms: u64| Moment::from_micros(ms * 1000);
        let mut pace = ReadingPace::default();
        assert_eq!(pace.stale_after(), STALE_AFTER_LEAST);
        (0..9).for_each(|nth| pace.take(at(nth * 10)));
        assert_eq!(pace.stale_after(), STALE_AFTER_LEAST, "100 Hz");
        (1..9).for_each(|nth| pace.take(at(80 + nth * 300)));
        assert_eq!(pace.stale_after(), Duration::from_millis(900), "3 Hz");
        pace.take(at(60_000));
        assert_eq!(pace.stale_after(), STALE_AFTER_MOST, "after a long silence");
    }
}
