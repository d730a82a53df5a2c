//! Counters for [`LinkStats`]: rates over the last second and percentiles over the last round trips.

use crate::hand::{Finger, Group, Groups, HandSample, Moment};
use crate::link::poll::meter::LineMeter;
use crate::link::stats::EventRate;
use crate::link::stats::{LineUse, LinkStats};
use std::collections::VecDeque;
use std::time::Duration;

/// Number of round trips that the percentiles cover.
const ROUND_TRIPS: usize = 512;
/// Interval at which percentiles are recomputed.
const DIGEST_INTERVAL: Duration = Duration::from_millis(250);

/// Counts one link.
#[derive(Debug, Default)]
pub(crate) struct Counters {
    pub(crate) stats: LinkStats,
    round_trips: VecDeque<Duration>,
    state: EventRate,
    tactile: EventRate,
    sweep: Sweep,
    pub(crate) line: LineMeter,
    digested: Moment,
}

impl Counters {
    pub(crate) fn round_trip(&mut self, took: Duration) {
        if self.round_trips.len() == ROUND_TRIPS {
            self.round_trips.pop_front();
        }
        self.round_trips.push_back(took);
    }

    /// Counts a reply with these groups of a sample, and whether it is plausible.
    pub(crate) fn judge(&mut self, sample: &HandSample, fresh: Groups) {
        if fresh.is_empty() {
            return;
        }
        self.stats.readings += 1;
        self.stats.implausible += u64::from(sample.is_implausible(fresh));
    }

    /// Counts new values of these groups.
    pub(crate) fn fresh(&mut self, fresh: Groups, now: Moment) {
        if fresh.contains(Group::Angle) {
            self.stats.state_reads += 1;
            self.state.hit(now);
        }
        if self.sweep.is_whole_with(fresh) {
            self.stats.tactile_reads += 1;
            self.tactile.hit(now);
        }
    }

    /// Updates rates and percentiles, at most once per interval.
    pub(crate) fn digest(&mut self, now: Moment) {
        if now.since(self.digested) < DIGEST_INTERVAL && self.stats.rtt_p50.is_some() {
            return;
        }
        self.digested = now;
        self.stats.state_hz = self.state.hz(now);
        self.stats.tactile_hz = self.tactile.hz(now);
        let mut sorted: Vec<Duration> = self.round_trips.iter().copied().collect();
        sorted.sort_unstable();
        self.stats.rtt_p50 = percentile(&sorted, 50);
        self.stats.rtt_p99 = percentile(&sorted, 99);
    }

    /// Resets rates and round trips after the link was lost; counts are preserved.
    pub(crate) fn lost(&mut self) {
        self.round_trips.clear();
        self.state = EventRate::default();
        self.tactile = EventRate::default();
        self.sweep = Sweep::default();
        self.line = LineMeter::default();
        self.stats.state_hz = 0.0;
        self.stats.tactile_hz = 0.0;
        self.stats.rtt_p50 = None;
        self.stats.rtt_p99 = None;
        self.stats.line = LineUse::default();
    }
}

/// The fingertips read since the last complete sweep of all five.
#[derive(Debug, Default)]
struct Sweep(Groups);

impl Sweep {
    fn is_whole_with(&mut self, fresh: Groups) -> bool {
        if !fresh.has_tactile() {
            return false;
        }
        for finger in Finger::ALL {
            if fresh.contains(Group::Tactile(finger)) {
                self.0.insert(Group::Tactile(finger));
            }
        }
        let whole = Finger::ALL
            .iter()
            .all(|finger| self.0.contains(Group::Tactile(*finger)));
        if whole {
            self.0 = Groups::NONE;
        }
        whole
    }
}

fn percentile(sorted: &[Duration], percent: usize) -> Option<Duration> {
    let last = sorted.len().checked_sub(1)?;
    sorted.get(last * percent / 100).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(all: &[Group]) -> Groups {
        let mut groups = Groups::NONE;
        for group in all {
            groups.insert(*group);
        }
        groups
    }

    #[test]
    fn rates_and_percentiles_come_from_the_last_second() {
        let mut counters = Counters::default();
        for n in 0..200u64 {
            let now = Moment::from_micros(n * 10_000);
            counters.fresh(groups(&[Group::Angle]), now);
            counters.round_trip(Duration::from_millis(if n % 50 == 0 { 30 } else { 5 }));
            counters.digest(now);
        }
        counters.digest(Moment::from_micros(2_250_000));
        assert!((counters.stats.state_hz - 100.0).abs() < 0.5);
        assert_eq!(counters.stats.rtt_p50, Some(Duration::from_millis(5)));
        assert_eq!(counters.stats.rtt_p99, Some(Duration::from_millis(30)));
        counters.lost();
        assert_eq!(
            (counters.stats.state_hz, counters.stats.rtt_p50),
            (0.0, None)
        );
        assert_eq!(counters.stats.state_reads, 200);
    }

    #[test]
    fn a_sweep_counts_once_all_five_fingertips_came_in_whatever_portions() {
        let mut counters = Counters::default();
        let tips = Finger::ALL.map(Group::Tactile);
        for portion in [&tips[..2], &tips[1..3], &[Group::Angle], &tips[2..4]] {
            counters.fresh(groups(portion), Moment::ZERO);
        }
        assert_eq!(counters.stats.tactile_reads, 0);
        counters.fresh(groups(&tips[4..]), Moment::ZERO);
        assert_eq!(counters.stats.tactile_reads, 1);
        counters.fresh(groups(&tips[..4]), Moment::ZERO);
        assert_eq!(counters.stats.tactile_reads, 1);
    }
}
