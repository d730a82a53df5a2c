//! Progress of a scan. Counts only; sends no requests.

use crate::link::scan::event::ScanSummary;
use crate::link::scan::plan::{Lane, LaneKind, ScanPlan, Try, estimate};
use std::time::Duration;

/// Progress of a scan.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ScanProgress {
    /// Probes that are done, sent or skipped.
    pub tried: usize,
    /// Planned probes.
    pub total: usize,
    /// Remaining time if no further probe is answered.
    pub left: Duration,
}

/// Remaining probes of each lane, and the results so far.
#[derive(Debug, Default)]
pub(crate) struct ScanTracker {
    total: usize,
    lanes: Vec<RemainingTries>,
    pub(crate) summary: ScanSummary,
}

#[derive(Debug)]
struct RemainingTries {
    kind: LaneKind,
    tries: usize,
    cost: Duration,
}

impl ScanTracker {
    pub(crate) fn new(plan: &ScanPlan) -> Self {
        let rest = |lane: &Lane| RemainingTries {
            kind: lane.kind,
            tries: lane.tries.len(),
            cost: lane.cost(),
        };
        Self {
            total: plan.tries(),
            lanes: plan.lanes.iter().map(rest).collect(),
            summary: ScanSummary::default(),
        }
    }

    /// Sets the remaining probes of a lane.
    pub(crate) fn left<'a>(&mut self, nth: usize, tries: impl Iterator<Item = &'a Try>) {
        let Some(lane) = self.lanes.get_mut(nth) else {
            return;
        };
        (lane.tries, lane.cost) = tries.fold((0, Duration::ZERO), |(count, cost), one| {
            (count + 1, cost + one.cost)
        });
    }

    pub(crate) fn progress(&self) -> ScanProgress {
        let open: usize = self.lanes.iter().map(|lane| lane.tries).sum();
        ScanProgress {
            tried: self.total.saturating_sub(open),
            total: self.total,
            left: estimate(self.lanes.iter().map(|lane| (lane.kind, lane.cost))),
        }
    }
}
