//! What the link measured of itself. Counting lives in the session; here is only the result.

use crate::hand::RateClass;
use std::time::Duration;

/// Counts since the link was opened, and rates over the last seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct LinkStats {
    /// Whole reads of the motion state.
    pub state_reads: u64,
    /// Whole sweeps over all five fingertips.
    pub tactile_reads: u64,
    /// Motion states a second, over the last second.
    pub state_hz: f64,
    /// Fingertip sweeps a second, over the last second.
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
    /// Replies that belonged to no open request: doubled, someone else's, or late where that cannot be known.
    pub foreign_replies: u64,
    /// Replies that came after their request was given up, where that can be known.
    pub late_replies: u64,
    /// Requests of another controller, and setpoints that it changed.
    pub foreign_requests: u64,
    /// Requests that the hand refused.
    pub refusals: u64,
    /// Replies that held values.
    pub readings: u64,
    /// Those of them with a value that no hand should send.
    pub implausible: u64,
    /// Times the wire was opened again.
    pub reconnects: u64,
    /// Register writes sent.
    pub writes: u64,
    /// Times that this program could not attend to the wire for 20 ms or more: the computer was busy with something else.
    pub stalls: u64,
    /// How long these lasted together.
    pub stalled: Duration,
    /// The longest of them.
    pub longest_stall: Duration,
    /// Samples that the window was too slow to take.
    pub dropped_events: u64,
    /// What the line is used for.
    pub line: LineUse,
}

/// How the time of the line is spent, over the last second.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct LineUse {
    /// Share of the time in which a request was open, or the silence after its reply was kept, 0 to 1. At full rate 1 is
    /// what the line and the hand can give.
    pub utilisation: f64,
    /// Share of the time in which bits were on the wire, 0 to 1; `None` where the wire has no speed of its own.
    pub on_wire: Option<f64>,
    /// The hand's turnaround as the link learnt it, with what adapter and system add; `None` before the first answer.
    pub turnaround: Option<Duration>,
    /// Share of the writes, 0 to 1.
    pub writes: f64,
    /// The groups of reads, in the order of [`RateClass::ALL`].
    pub groups: [GroupUse; RateClass::ALL.len()],
    /// True if windows end at gaps between registers, because this hand refuses to be read through them.
    pub split: bool,
}

/// What one group of reads gets, and what the wire could give.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct GroupUse {
    /// Whole reads of the group a second.
    pub hz: f64,
    /// Its share of the time, 0 to 1.
    pub share: f64,
    /// Whole reads a second that the wire would give if it carried nothing else; 0 before the first answer.
    pub could_hz: f64,
}
