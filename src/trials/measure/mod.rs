//! Analysis of a recorded trial: curves, onsets, slips, and the metrics computed from them.

pub mod curve;
pub mod detect;
pub mod metrics;
#[cfg(test)]
pub(crate) mod metrics_tests;
pub mod slip;
pub mod unseen;
