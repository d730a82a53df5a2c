//! Measurements of the link itself. The session does the counting.

use crate::hand::{Moment, RateClass};
use std::collections::VecDeque;
use std::time::Duration;

/// Counts since the link was opened, and rates over the last seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct LinkStats {
    /// Complete reads of the motion state.
    pub state_reads: u64,
    /// Complete sweeps over all five fingertips.
    pub tactile_reads: u64,
    /// Motion states per second, over the last second.
    pub state_hz: f64,
    /// Fingertip sweeps per second, over the last second.
    pub tactile_hz: f64,
    /// Median round trip of the last requests.
    pub rtt_p50: Option<Duration>,
    /// 99th percentile of the same.
    pub rtt_p99: Option<Duration>,
    /// Requests without a reply in time.
    pub timeouts: u64,
    /// Frames with a wrong checksum.
    pub checksum_errors: u64,
    /// Times that noise was skipped.
    pub resyncs: u64,
    /// Replies without an open request: duplicates, replies to another controller, or late ones that cannot be identified.
    pub foreign_replies: u64,
    /// Replies that came after their request timed out, where they can be identified.
    pub late_replies: u64,
    /// Requests of another controller, and setpoints that it changed.
    pub foreign_requests: u64,
    /// Requests that the hand refused.
    pub refusals: u64,
    /// Replies with values.
    pub readings: u64,
    /// Replies with a value that no hand should send.
    pub implausible: u64,
    /// Number of times the wire was reopened.
    pub reconnects: u64,
    /// Register writes sent.
    pub writes: u64,
    /// Number of times this program failed to service the wire for 20 ms or more because the computer was busy.
    pub stalls: u64,
    /// Total time of these stalls.
    pub stalled: Duration,
    /// The longest of these stalls.
    pub longest_stall: Duration,
    /// Samples that were dropped because the window was too slow.
    pub dropped_events: u64,
    /// Usage of the line.
    pub line: LineUse,
}

/// Usage of the line's time over the last second.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct LineUse {
    /// Share of the time with a request open, or with the silence after its reply, 0 to 1. At full rate, 1 is the limit
    /// of the line and the hand.
    pub utilisation: f64,
    /// Share of the time with bits on the wire, 0 to 1; `None` if the wire has no bit rate of its own.
    pub on_wire: Option<f64>,
    /// The hand's measured turnaround, including adapter and system; `None` before the first reply.
    pub turnaround: Option<Duration>,
    /// Share of the time used for writes, 0 to 1.
    pub writes: f64,
    /// The groups of reads, in the order of [`RateClass::ALL`].
    pub groups: [GroupUse; RateClass::ALL.len()],
    /// True if windows end at gaps between registers, because this hand refuses to be read through them.
    pub split: bool,
}

/// Actual and possible rate of one group of reads.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct GroupUse {
    /// Complete reads of the group per second.
    pub hz: f64,
    /// Share of the time used for the group, 0 to 1.
    pub share: f64,
    /// Complete reads per second that the wire would allow if it carried nothing else; 0 before the first reply.
    pub could_hz: f64,
}

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
