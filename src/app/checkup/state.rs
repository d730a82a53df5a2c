//! The running check-up of a hand, and the last result.

use crate::app::env::running::Running;
use crate::checkup::CheckupPlan;
use crate::checkup::report::{CheckupReport, PAGE_FILE};
use crate::checkup::run::CheckupView;
use crate::hand::{ArmEpoch, Moment};
use crate::motion::checkup::ConcludedCheckup;
use crate::record::Abort;
use crate::store::{JobKind, Jobs};
use std::io;
use std::path::PathBuf;
use std::time::Duration;
use tokio::sync::oneshot;

#[derive(Debug, Default)]
pub struct HandCheckup {
    /// The last check-up: of this run of the program, else the last stored one.
    pub last: Option<ShownCheckup>,
    /// Reason why the stored check-ups cannot be read.
    pub unread: Option<String>,
    pub(crate) jobs: Jobs<ReadLastCheckup>,
    /// True once stored check-ups have been requested.
    pub(crate) is_read: bool,
}

/// Background job of check-ups: reading the last stored one.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct ReadLastCheckup;

impl JobKind for ReadLastCheckup {
    type State = HandCheckup;
    type Ctx<'a> = ();
}

/// A finished check-up.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownCheckup {
    pub report: CheckupReport,
    /// HTML report; `None` if it was not written.
    pub page: Option<PathBuf>,
}

impl ShownCheckup {
    pub(crate) fn of((report, folder): (CheckupReport, Option<PathBuf>)) -> Self {
        let page = folder.map(|folder| folder.join(PAGE_FILE));
        Self { report, page }
    }
}

/// A running check-up, as the window sees it.
#[derive(Debug)]
pub struct CheckupRun {
    /// Current progress.
    pub view: CheckupView,
    pub epoch: ArmEpoch,
    /// Start of the current step.
    pub since: Moment,
    pub(crate) end: Option<oneshot::Sender<Abort>>,
    pub(crate) task: Running<CheckupView, io::Result<ConcludedCheckup>>,
}

impl CheckupRun {
    /// Approximate remaining time if nothing ends the check-up early.
    pub fn left(&self, now: Moment) -> Duration {
        self.view.left.saturating_sub(now.since(self.since))
    }

    /// Ends the check-up early. The caller stops the hand, and the task makes sure of it.
    pub(crate) fn end(&mut self, why: Abort) {
        if let Some(end) = self.end.take() {
            // A finished task no longer listens.
            let _heard = end.send(why);
        }
    }
}

impl HandCheckup {
    /// True while the stored check-ups are being read.
    pub const fn is_reading(&self) -> bool {
        !self.jobs.is_empty()
    }
}

/// User requests concerning check-ups. By sending one, the user confirms that the hand is empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum CheckupAction {
    /// Start a check-up in the current arming. Needs arming.
    Start(CheckupPlan),
    /// Arm the hand, and start a check-up once it is armed.
    ArmAndStart(CheckupPlan),
}
