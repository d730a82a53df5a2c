//! The check-up that runs at a hand, and what the last one came to.

use crate::app::env::running::Running;
use crate::checkup::CheckupPlan;
use crate::checkup::report::{CheckupReport, PAGE_FILE};
use crate::checkup::run::CheckupView;
use crate::hand::{ArmEpoch, Moment};
use crate::record::Abort;
use crate::store::BackgroundJob;
use crate::tasks::checkup::ConcludedCheckup;
use std::io;
use std::path::PathBuf;
use std::time::Duration;
use tokio::sync::oneshot;

/// What the last kept check-up came to, where its report is.
pub(crate) type KeptCheckup = io::Result<Option<(CheckupReport, Option<PathBuf>)>>;

/// Check-ups of one hand.
#[derive(Debug, Default)]
pub struct HandCheckup {
    /// The one that runs.
    pub run: Option<CheckupRun>,
    /// The last one: of this run of the program, or the last that was kept.
    pub last: Option<ShownCheckup>,
    /// Why those that were kept cannot be read.
    pub unread: Option<String>,
    pub(crate) looking: Option<BackgroundJob<KeptCheckup>>,
    /// What was kept was looked for.
    pub(crate) is_looked: bool,
}

/// A check-up that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownCheckup {
    pub report: CheckupReport,
    /// Its page, if it was written.
    pub page: Option<PathBuf>,
}

impl ShownCheckup {
    pub(crate) fn of((report, folder): (CheckupReport, Option<PathBuf>)) -> Self {
        let page = folder.map(|folder| folder.join(PAGE_FILE));
        Self { report, page }
    }
}

/// A check-up on its way, as the window sees it.
#[derive(Debug)]
pub struct CheckupRun {
    /// Where it stands.
    pub view: CheckupView,
    /// Its arming.
    pub epoch: ArmEpoch,
    /// When the step of now began.
    pub since: Moment,
    pub(crate) end: Option<oneshot::Sender<Abort>>,
    pub(crate) task: Running<CheckupView, io::Result<ConcludedCheckup>>,
}

impl CheckupRun {
    /// About how long the rest of it takes, if nothing ends it.
    pub fn left(&self, now: Moment) -> Duration {
        self.view.left.saturating_sub(now.since(self.since))
    }

    /// Ends it early. The stop itself is the caller's, and the task sees to it.
    pub(crate) fn end(&mut self, why: Abort) {
        if let Some(end) = self.end.take() {
            // One that is over hears it no more.
            let _heard = end.send(why);
        }
    }
}

impl HandCheckup {
    /// True while the kept ones are being read, and nothing is known of any.
    pub const fn is_reading(&self) -> bool {
        self.looking.is_some()
    }
}

/// What the user asks for about check-ups. The hand is empty, they say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum CheckupAction {
    /// Run one, in the arming that is in force. Needs arming.
    Start(CheckupPlan),
    /// Arm the hand, and run one as soon as that holds.
    ArmAndStart(CheckupPlan),
}
