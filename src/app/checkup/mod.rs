//! Check-ups in the window: the one that runs, and what the last one came to. What is measured and judged is in
//! [`crate::checkup`]. Draws nothing.

pub mod state;
pub(crate) mod work;

pub use crate::app::checkup::state::{CheckupAction, CheckupRun, HandCheckup, ShownCheckup};
