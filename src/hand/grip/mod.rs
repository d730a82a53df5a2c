//! What is gripped: the state of each finger and of the grasp, from what the hand reads. No clock; each reading brings its moment.

mod estimator;
mod evidence;
mod finger;
mod motion;
pub mod slip;
mod state;
mod thresholds;

pub use estimator::GripEstimator;
pub use state::{Grip, GripEstimate, GripState};
pub use thresholds::{GripThreshold, GripThresholds};
