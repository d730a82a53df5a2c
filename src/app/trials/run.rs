//! A series on its way, as the window sees it: where it stands.

use crate::app::env::running::Running;
use crate::app::trials::state::SessionId;
use crate::hand::{ArmEpoch, Moment};
use crate::record::Abort;
use crate::tasks::series::SeriesStep;
use crate::trials::plan::TrialPlan;
use crate::trials::search::Finding;
use crate::trials::series::SeriesView;
use std::time::Duration;
use tokio::sync::oneshot;

/// How a series ended: why early, if it did, and what a search came to.
#[derive(Debug)]
pub(crate) struct SeriesEnd {
    pub(crate) aborted: Option<Abort>,
    pub(crate) finding: Option<Finding>,
}

/// A running series.
#[derive(Debug)]
pub struct SeriesRun {
    /// Where it stands.
    pub view: SeriesView,
    /// Its arming.
    pub epoch: ArmEpoch,
    /// Where its trials go.
    pub session: SessionId,
    pub plan: TrialPlan,
    /// When the trial of now began, or the wait for it.
    pub since: Moment,
    /// What times of the trial of now are counted from: the closing command, and its beginning before that.
    pub zero: Moment,
    /// About how long one trial takes with the rest after it.
    pub(crate) each: Duration,
    pub(crate) end: Option<oneshot::Sender<Abort>>,
    pub(crate) task: Option<Running<SeriesStep, SeriesEnd>>,
}

impl SeriesRun {
    /// About how long the rest of it takes, if nothing ends it.
    pub fn left(&self, now: Moment) -> Duration {
        let ahead = self.view.total.saturating_sub(self.view.number);
        let ahead = self.each * u32::try_from(ahead).unwrap_or(u32::MAX);
        ahead + self.each.saturating_sub(now.since(self.since))
    }

    /// Ends it early. The stop itself is the caller's, and the task sees to it.
    pub(crate) fn end(&mut self, why: Abort) {
        if let Some(end) = self.end.take() {
            // One that is over hears it no more.
            let _heard = end.send(why);
        }
    }
}
