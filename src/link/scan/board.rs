//! How far a scan is. Counts; asks nobody.

use crate::link::scan::event::ScanSummary;
use crate::link::scan::plan::{Lane, LaneKind, ScanPlan, Try, estimate};
use std::time::Duration;

/// How far a scan is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ScanProgress {
    /// Questions that are done with, asked or not needed any more.
    pub tried: usize,
    /// Questions that were planned.
    pub total: usize,
    /// Time until the end if nobody answers any more.
    pub left: Duration,
}

/// What is left of each lane, and the results of the others.
#[derive(Debug, Default)]
pub(crate) struct Board {
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

impl Board {
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

    /// Notes what is left of a lane.
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
