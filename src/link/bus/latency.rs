//! Detects a USB adapter's latency timer from round trips: short replies wait for its next tick.

use arrayvec::ArrayVec;
use std::time::Duration;

/// Longest reply, in memory bytes, that an adapter holds back until its timer ticks; a fuller packet is forwarded at once.
const BYTES_MAX: u16 = 48;
/// Round trips that a verdict needs, and considers.
const TRIPS: usize = 16;
/// Default tick of adapters.
const TICK_MS: u128 = 16;
/// Tolerance of a round trip around a tick, either way.
const SPREAD_MS: u128 = 2;

/// The last round trips of short replies.
#[derive(Debug, Clone, Default)]
pub struct Ticks {
    trips: ArrayVec<Duration, TRIPS>,
}

impl Ticks {
    /// Records that a reply of this many memory bytes took this long, measured at this end.
    pub fn record(&mut self, bytes: u16, trip: Duration) {
        if bytes > BYTES_MAX {
            return;
        }
        if self.trips.is_full() {
            self.trips.remove(0);
        }
        self.trips.push(trip);
    }

    /// True if the replies arrive at the ticks of a timer of 16 ms: nearly all after one, or nearly all after two.
    pub fn are_seen(&self) -> bool {
        let near = |tick: u128| {
            let on_it = |trip: &&Duration| trip.as_millis().abs_diff(tick) < SPREAD_MS;
            self.trips.iter().filter(on_it).count() >= TRIPS - 2
        };
        self.trips.is_full() && (near(TICK_MS) || near(2 * TICK_MS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(micros: impl Fn(u64) -> u64) -> bool {
        let mut ticks = Ticks::default();
        for n in 0..40 {
            ticks.record(12, Duration::from_micros(micros(n)));
            // Long replies do not wait, and do not count.
            ticks.record(232, Duration::from_millis(40));
        }
        ticks.are_seen()
    }

    #[test]
    fn a_plateau_at_one_or_two_ticks_is_a_timer() {
        assert!(seen(|n| 15_600 + n % 5 * 200));
        assert!(seen(|n| 31_500 + n % 5 * 200));
        // One reply in ten was quicker.
        assert!(seen(|n| if n % 10 == 0 { 8_000 } else { 16_100 }));
    }

    #[test]
    fn quick_scattered_or_few_round_trips_are_none() {
        assert!(!seen(|n| 6_000 + n % 7 * 1_000));
        assert!(!seen(|n| 4_000 + n % 13 * 2_000));
        assert!(!seen(|_| 300));
        let mut few = Ticks::default();
        few.record(12, Duration::from_millis(16));
        assert!(!few.are_seen());
    }
}
