//! Check-ups in the window: the running one and the last result. Measurements and judgements are defined in
//! [`crate::checkup`]. Draws nothing.

pub mod state;
pub(crate) mod work;

pub use crate::app::checkup::state::{CheckupAction, CheckupRun, HandCheckup, ShownCheckup};
