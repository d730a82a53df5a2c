//! What the link measured of itself. Counting lives in the session; here is only the result.

use std::time::Duration;

/// Counts since the link was opened, and rates over the last seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
    /// Replies that belonged to no open request: late, doubled, or someone else's.
    pub foreign_replies: u64,
    /// Requests of another controller, and setpoints that it changed.
    pub foreign_requests: u64,
    /// Requests that the hand refused.
    pub refusals: u64,
    /// Times the wire was opened again.
    pub reconnects: u64,
    /// Register writes sent.
    pub writes: u64,
    /// Samples that the window was too slow to take.
    pub dropped_events: u64,
}
