//! Event rates.

use crate::hand::Moment;
use std::collections::VecDeque;
use std::time::Duration;

/// Time window of the rates.
const RATE_OVER: Duration = Duration::from_secs(1);
/// Maximum events in the window: more than any wire delivers.
const RATE_EVENTS: usize = 16_384;

/// Rate of events over the last second.
#[derive(Debug, Default)]
pub(crate) struct EventRate {
    hits: VecDeque<Moment>,
}

impl EventRate {
    /// Counts an event.
    pub(crate) fn hit(&mut self, now: Moment) {
        if self.hits.len() == RATE_EVENTS {
            self.hits.pop_front();
        }
        self.hits.push_back(now);
        self.forget(now);
    }

    fn forget(&mut self, now: Moment) {
        while self
            .hits
            .front()
            .is_some_and(|hit| now.since(*hit) > RATE_OVER)
        {
            self.hits.pop_front();
        }
    }

    /// Events per second at `now`, between the oldest and the newest of the last second.
    pub(crate) fn hz(&mut self, now: Moment) -> f64 {
        self.forget(now);
        let (Some(first), Some(last)) = (self.hits.front(), self.hits.back()) else {
            return 0.0;
        };
        let (span, steps) = (
            last.since(*first).as_secs_f64(),
            self.hits.len().saturating_sub(1),
        );
        let steps = f64::from(u32::try_from(steps).unwrap_or(u32::MAX));
        if span > 0.0 { steps / span } else { 0.0 }
    }
}
