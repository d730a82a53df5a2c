//! What is done to a hand only under a card: a change of its place, the return to the factory's parameters, the calibration of its
//! force sensors. Each has its rules in a pure module of its own ([`change`], [`reset`], [`calibration`](crate::app::calibration));
//! `keeper` carries them out over the program's one link, one `errand` at a time, with `files` for the records. Draws nothing.

pub mod change;
#[cfg(test)]
mod change_tests;
pub(crate) mod errand;
pub(crate) mod files;
pub mod guarded;
pub(crate) mod keeper;
pub mod reset;

pub use guarded::{Doing, Flow, GuardStep, Guarded, NotNow, WayTo, not_now};
