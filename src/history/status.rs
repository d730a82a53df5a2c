//! Status and faults of each drive over time: one entry for each period without a change. Bounded.

use crate::hand::{Dof, Faults, PerDof, Status};
use std::collections::VecDeque;

/// Maximum number of runs per joint: one a second for half an hour. The oldest are dropped first.
const RUNS_MAX: usize = 2048;

/// A period in which a drive's status and faults did not change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatusRun {
    /// Time of the first reading, in seconds.
    pub from_s: f64,
    /// Time until which the state is known to have lasted, in seconds.
    pub until_s: f64,
    /// `None` where it was not read.
    pub status: Option<Status>,
    /// `None` where they were not read.
    pub faults: Option<Faults>,
}

/// The newest runs of each joint, oldest first.
#[derive(Debug, Clone)]
pub(crate) struct StatusRuns {
    runs: PerDof<VecDeque<StatusRun>>,
    /// After a longer silence the state is unknown, in seconds.
    gap_after_s: f64,
    /// False after a gap: the next reading starts a new run.
    goes_on: bool,
}

impl StatusRuns {
    /// No runs yet; a silence longer than `gap_after_s` ends one.
    pub(crate) fn new(gap_after_s: f64) -> Self {
        Self {
            runs: PerDof::from_fn(|_| VecDeque::new()),
            gap_after_s,
            goes_on: false,
        }
    }

    /// Adds the drives' current state.
    pub(crate) fn push(
        &mut self,
        at_s: f64,
        say: impl Fn(Dof) -> (Option<Status>, Option<Faults>),
    ) {
        for (dof, runs) in self.runs.iter_mut() {
            let (status, faults) = say(dof);
            let last = runs.back_mut().filter(|_| self.goes_on);
            if let Some(last) = last.filter(|last| at_s - last.until_s <= self.gap_after_s) {
                last.until_s = at_s.max(last.until_s);
                if (last.status, last.faults) == (status, faults) {
                    continue;
                }
            }
            if runs.len() >= RUNS_MAX {
                runs.pop_front();
            }
            runs.push_back(StatusRun {
                from_s: at_s,
                until_s: at_s,
                status,
                faults,
            });
        }
        self.goes_on = true;
    }

    /// Ends the current runs, because the link was lost.
    pub(crate) const fn gap(&mut self) {
        self.goes_on = false;
    }

    /// Runs of a joint that overlap a time range, oldest first.
    pub(crate) fn between(
        &self,
        dof: Dof,
        from_s: f64,
        to_s: f64,
    ) -> impl Iterator<Item = &StatusRun> {
        let runs = &self.runs[dof];
        let first = runs.partition_point(|run| run.until_s < from_s);
        runs.range(first..)
            .take_while(move |run| run.from_s <= to_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_drive_says_is_one_stretch_until_it_says_something_else_or_nobody_listens() {
        let mut all = StatusRuns::new(0.5);
        let none = Some(Faults::default());
        let mut say = |at_s, status| all.push(at_s, |_| (Some(status), none));
        say(1.0, Status::Grasping);
        say(1.1, Status::Grasping);
        say(1.2, Status::ForceReached);
        say(9.0, Status::ForceReached);
        all.gap();
        all.push(9.5, |_| (Some(Status::ForceReached), none));
        let shown = |from_s, to_s| -> Vec<(f64, f64)> {
            let runs = all.between(Dof::Index, from_s, to_s);
            runs.map(|run| (run.from_s, run.until_s)).collect()
        };
        let whole = [(1.0, 1.2), (1.2, 1.2), (9.0, 9.0), (9.5, 9.5)];
        assert_eq!(shown(0.0, 10.0), whole);
        assert_eq!(shown(1.15, 1.3), [(1.0, 1.2), (1.2, 1.2)]);
        assert_eq!(shown(2.0, 8.0), []);
    }

    #[test]
    fn the_oldest_stretches_go_first() {
        let mut all = StatusRuns::new(3.0);
        for second in 0..3000_u16 {
            let status = if second % 2 == 0 {
                Status::Grasping
            } else {
                Status::Releasing
            };
            all.push(f64::from(second), |_| (Some(status), None));
        }
        let kept: Vec<_> = all.between(Dof::Little, 0.0, 1e9).collect();
        assert_eq!(kept.len(), RUNS_MAX);
        assert_eq!(kept.last().map(|run| run.from_s), Some(2999.0));
    }
}
