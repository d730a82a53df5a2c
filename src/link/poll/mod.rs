//! What is read when: the plan, what reading costs on a line, and what the line gave.

pub(crate) mod cost;
pub mod line_time;
pub(crate) mod meter;
pub mod plan;
#[cfg(test)]
pub(crate) mod plan_tests;
pub(crate) mod window;
