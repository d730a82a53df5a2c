//! What the feedback tells beside its values: that it stands still, that another writes, what was asked for and what was kept.

pub(crate) mod feedback;
pub(crate) mod heat;
pub(crate) mod other_controller;
pub(crate) mod save;
#[cfg(test)]
mod save_tests;
pub(crate) mod setpoint;
