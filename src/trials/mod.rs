//! Grasp trials: plan, run, recording, metrics and files. Draws nothing.
//!
//! [`plan`] defines a series of trials ([`plan_settings`] stores it between starts of the program); [`series`] runs it on virtual or
//! real time and returns the commands to send ([`runner`] for one trial, [`limits`] for its early end); [`recording`] holds the
//! readings; [`measure`] computes metrics from it offline; [`summary`] is one finished trial; [`columns`] are the columns of all
//! tables; [`session`] is a folder of trials, [`report`] its page, [`best`] finds the best setting; [`search`] searches for it close
//! by close; [`overshoot_file`] stores all measured overshoots of a hand.

pub mod best;
pub mod columns;
pub mod estimate;
pub mod limits;
pub mod measure;
pub mod overshoot_file;
pub mod plan;
pub mod plan_settings;
pub mod recording;
pub mod report;
pub mod runner;
pub mod search;
pub mod series;
#[cfg(test)]
pub(crate) mod series_tests;
pub mod session;
pub mod session_writer;
pub mod summary;

pub use crate::trials::best::{Criterion, Score};
pub use crate::trials::measure::metrics::{JointMetrics, measure};
pub use crate::trials::plan::{
    Approach, Limits, PlanError, TrialGrid, TrialPlan, TrialSetting, Until,
};
pub use crate::trials::recording::{TrialEvent, TrialMark, TrialRecording};
pub use crate::trials::runner::Stage;
pub use crate::trials::series::TrialSeries;
pub use crate::trials::summary::{EarlyEnd, Trial, TrialKind, TrialSummary};
