//! Polling: the plan, the cost of reads on a line, and the measured line usage.

pub(crate) mod cost;
pub mod line_time;
pub(crate) mod meter;
pub mod plan;
#[cfg(test)]
pub(crate) mod plan_tests;
pub(crate) mod window;
