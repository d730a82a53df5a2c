//! Results of a check-up of one hand and the connection to it, as plain values.

use crate::hand::Span;
use crate::link::{LinkStats, LinkStatus, line_time};
use crate::transport::can_facts::CanFacts;
use crate::transport::{Endpoint, PortFacts, Route};
use std::collections::VecDeque;
use std::time::Duration;

/// Maximum number of round trips per block: limits a check-up of a day, and the newest count.
const TRIPS_MAX: usize = 65_536;
/// Upper edges of the histogram in milliseconds; longer round trips go into one more bin.
pub(crate) const EDGES_MS: [u64; 7] = [1, 2, 4, 8, 16, 32, 64];

/// One check-up of one hand.
pub(crate) struct Examination {
    pub(crate) endpoint: Endpoint,
    pub(crate) connection: ConnectionFacts,
    /// The measurements, or the reason why the hand did not answer.
    pub(crate) answer: Result<LinkMeasurements, String>,
}

/// Type of the connection, as the system reports it.
pub(crate) enum ConnectionFacts {
    /// Built into this program.
    BuiltIn,
    /// Serial port.
    Port(PortFacts),
    /// Network; `None` if the system has no route.
    Net(Option<Route>),
    /// CAN interface.
    Can(CanFacts),
}

/// Measurements of an answering hand.
pub(crate) struct LinkMeasurements {
    /// Time from opening to the first answer.
    pub(crate) answered_after: Duration,
    pub(crate) status: LinkStatus,
    pub(crate) stats: LinkStats,
    pub(crate) windows: Vec<BlockTiming>,
    /// True if round trips of short replies cluster at the ticks of a latency timer.
    pub(crate) ticks_seen: bool,
    /// Reason if the link was lost during the measurement.
    pub(crate) lost: Option<String>,
}

/// A block of registers, read repeatedly.
pub(crate) struct BlockTiming {
    pub(crate) name: &'static str,
    pub(crate) span: Span,
    /// Minimum transmission time on the line; `None` if its speed is unknown.
    pub(crate) line: Option<Duration>,
    pub(crate) refused: u64,
    pub(crate) failed: u64,
    pub(crate) reads: u64,
    trips: VecDeque<Duration>,
}

impl BlockTiming {
    pub(crate) fn new(name: &'static str, span: Span, endpoint: &Endpoint) -> Self {
        Self {
            name,
            span,
            line: line_time(endpoint, span.len),
            refused: 0,
            failed: 0,
            reads: 0,
            trips: VecDeque::new(),
        }
    }

    pub(crate) fn add(&mut self, trip: Duration) {
        self.reads += 1;
        if self.trips.len() == TRIPS_MAX {
            self.trips.pop_front();
        }
        self.trips.push_back(trip);
    }

    /// Round trip at this percentile.
    pub(crate) fn percentile(&self, percent: usize) -> Option<Duration> {
        let mut sorted: Vec<Duration> = self.trips.iter().copied().collect();
        sorted.sort_unstable();
        let last = sorted.len().checked_sub(1)?;
        sorted.get(last * percent / 100).copied()
    }

    /// Rate in reads per second if only this block were read.
    pub(crate) fn hz(&self) -> Option<f64> {
        let all: Duration = self.trips.iter().sum();
        let count = u32::try_from(self.trips.len())
            .ok()
            .filter(|count| *count > 0)?;
        let mean = all.as_secs_f64() / f64::from(count);
        (mean > 0.0).then(|| 1.0 / mean)
    }

    /// The same without delays of hand and adapter.
    pub(crate) fn line_hz(&self) -> Option<f64> {
        let seconds = self.line?.as_secs_f64();
        (seconds > 0.0).then(|| 1.0 / seconds)
    }

    /// Number of round trips between each edge and the previous one; the last bin holds the rest.
    pub(crate) fn histogram(&self) -> [u64; EDGES_MS.len() + 1] {
        let mut counts = [0; EDGES_MS.len() + 1];
        for trip in &self.trips {
            let place = EDGES_MS
                .iter()
                .position(|edge| *trip < Duration::from_millis(*edge));
            if let Some(count) = counts.get_mut(place.unwrap_or(EDGES_MS.len())) {
                *count += 1;
            }
        }
        counts
    }
}

impl LinkMeasurements {
    /// Number of requests of the check-up, answered or not.
    pub(crate) fn requests(&self) -> u64 {
        let asked = |window: &BlockTiming| window.reads + window.refused + window.failed;
        self.windows.iter().map(asked).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_counts_its_round_trips() {
        let endpoint = "rs485:/dev/ttyT0".parse().unwrap();
        let mut window = BlockTiming::new("angles", Span::new(1546, 12), &endpoint);
        assert_eq!((window.percentile(50), window.hz()), (None, None));
        for ms in [0, 1, 3, 5, 9, 20, 40, 100] {
            window.add(Duration::from_millis(ms));
        }
        assert_eq!(window.histogram(), [1; 8]);
        assert_eq!(window.percentile(0), Some(Duration::ZERO));
        assert_eq!(window.percentile(50), Some(Duration::from_millis(5)));
        assert_eq!(window.percentile(100), Some(Duration::from_millis(100)));
        assert_eq!(window.hz(), Some(8.0 / 0.178));
        let line = window.line_hz().unwrap();
        assert!((397.0..398.0).contains(&line), "{line}");
    }

    #[test]
    fn a_long_look_stays_small() {
        let mut window = BlockTiming::new("angles", Span::new(1546, 12), &Endpoint::sim());
        for _ in 0..=TRIPS_MAX {
            window.add(Duration::from_millis(1));
        }
        assert_eq!(window.trips.len(), TRIPS_MAX);
        assert_eq!(window.reads, TRIPS_MAX as u64 + 1);
    }
}
