//! Grasp trials: what is to be tried, its running, its recording, what was measured, its files. Draws nothing.
//!
//! [`plan`] says what is tried; [`series`] runs it on virtual or real time and gives what to send ([`runner`] one
//! trial, [`watch`] what ends it); [`recording`] keeps what was read; [`metrics`] computes from it, without looking at
//! the hand again; [`session`] keeps all of it in a folder, [`report`] as a page; [`best`] finds the best setting.

pub mod best;
pub mod curve;
pub mod detect;
pub mod estimate;
pub mod metrics;
#[cfg(test)]
mod metrics_tests;
pub mod plan;
pub mod read;
pub mod recording;
pub mod report;
pub mod runner;
pub mod series;
#[cfg(test)]
mod series_tests;
pub mod session;
#[cfg(test)]
mod session_tests;
pub mod slip;
mod svg;
mod together;
pub mod watch;

use crate::link::PollRates;

pub use best::{Criterion, Score};
pub use metrics::{JointMetrics, TrialMetrics, measure};
pub use plan::{Approach, Grid, Limits, PlanError, Setting, TrialPlan, Until};
pub use recording::{Mark, Recording, What};
pub use runner::Stage;
pub use series::{Kind, Order, Series, Trial};
pub use watch::{Abort, LinkView};

/// How a hand is read during a series: as fast as a serial line goes; on faster wires no faster than ten times the
/// hand's own control. Fingertips a little more often than their sensors measure, and no more, so that slow lines have
/// turns for forces and faults. Settings often enough that a trial need not wait for them.
pub const RATES: PollRates = PollRates {
    state_hz: 500.0,
    tactile_hz: 60.0,
    settings_hz: 5.0,
};
