//! What a recorded trial comes to: curves, where they begin to rise, slips, and the metrics that are made of them.

pub mod curve;
pub mod detect;
pub mod metrics;
#[cfg(test)]
pub(crate) mod metrics_tests;
pub mod slip;
pub mod unseen;
