//! Grasp trials: what is to be tried, its running, its recording, what was measured, its files. Draws nothing.
//!
//! [`plan`] says what is tried ([`plan_settings`] keeps it from one start to the next); [`series`] runs it on virtual or real
//! time and gives what to send ([`runner`] one trial, [`limits`] what ends it); [`recording`] keeps what was read;
//! [`measure`] computes from it, without looking at the hand again; [`summary`] is one trial that is over; [`columns`] are
//! the columns of every table; [`session`] is a folder of them, [`report`] its page, [`best`]
//! finds the best setting; [`search`] searches for it close after close; [`overshoot_file`] keeps what all of them measured of a hand.

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
