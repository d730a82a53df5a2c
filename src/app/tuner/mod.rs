//! Grasp trials in the window: the plan that is being written, the series that runs, what was tried, and its files.
//! What a trial is and how it is measured is in [`crate::app::trial`]. Draws nothing.

pub(crate) mod act;
#[cfg(test)]
mod act_tests;
pub mod book;
pub mod comparison;
#[cfg(test)]
mod comparison_tests;
pub mod draft;
pub(crate) mod files;
pub mod kept;
pub mod lines;
pub mod wish;

pub use act::StartRefusal;
pub use book::{Ended, Origin, Run, Session, SessionId, Tried, TunerBook};
pub use comparison::{Comparison, Difference, Group, Picture, Place};
pub use draft::{Draft, Field, Reach};
pub use lines::{Lines, Shown};
pub use wish::TrialWish;
