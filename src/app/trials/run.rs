//! A series on its way, as the window sees it: where it stands, and what was read in the trial that runs.

use crate::app::running::Running;
use crate::app::trials::state::SessionId;
use crate::hand::{ArmEpoch, Moment};
use crate::record::Record;
use crate::tasks::series::{SeriesReport, SeriesStep};
use crate::trials::plan::{PlanError, TrialPlan, TrialSetting};
use crate::trials::recording::TrialRecording;
use crate::trials::series::SeriesView;
use crate::trials::{Abort, estimate};
use std::time::Duration;
use tokio::sync::oneshot;

/// A running series.
#[derive(Debug)]
pub struct SeriesRun {
    /// Where it stands.
    pub view: SeriesView,
    /// Its arming.
    pub epoch: ArmEpoch,
    /// Where its trials go.
    pub session: SessionId,
    /// The plan.
    pub plan: TrialPlan,
    /// When the trial of now began, or the wait for it.
    pub since: Moment,
    /// What was read in the trial of now.
    pub recording: TrialRecording,
    pub(crate) end: Option<oneshot::Sender<Abort>>,
    pub(crate) task: Option<Running<SeriesStep, Result<SeriesReport, PlanError>>>,
}

impl SeriesRun {
    /// About how long the rest of it takes, if nothing ends it.
    #[must_use]
    pub fn left(&self, now: Moment) -> Duration {
        let all = self.plan.grid.settings();
        let ahead = all
            .iter()
            .skip(self.view.number.saturating_sub(self.probes()));
        let ahead: Duration = ahead.map(|own| estimate::trial(&self.plan, *own)).sum();
        let of_now = |own: TrialSetting| estimate::trial(&self.plan, own);
        let of_now = self.view.setting.map_or(Duration::ZERO, of_now);
        ahead + of_now.saturating_sub(now.since(self.since))
    }

    /// Trials that only look for the contact.
    fn probes(&self) -> usize {
        self.view
            .total
            .saturating_sub(self.plan.grid.settings().len())
    }

    /// Ends it early. The stop itself is the caller's, and the task sees to it.
    pub(crate) fn end(&mut self, why: Abort) {
        if let Some(end) = self.end.take() {
            // One that is over hears it no more.
            let _heard = end.send(why);
        }
    }

    /// Takes a sample.
    pub(crate) fn take(&mut self, record: &Record) {
        if let Record::Reading { sample, fresh } = record
            && self.view.setting.is_some()
        {
            self.recording.push(sample, *fresh);
        }
    }
}
