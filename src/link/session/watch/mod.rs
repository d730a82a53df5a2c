//! Checks of the feedback: frozen values, another controller, heat, setpoints and SAVE results.

pub(crate) mod feedback;
pub(crate) mod heat;
pub(crate) mod other_controller;
pub(crate) mod save;
#[cfg(test)]
mod save_tests;
pub(crate) mod setpoint;
