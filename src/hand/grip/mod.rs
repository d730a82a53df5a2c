//! Grip estimation: the state of each finger and of the grasp, from the hand's readings. No clock; each reading carries its time.

mod contact;
mod estimator;
mod evidence;
mod finger;
mod free;
mod motion;
pub mod slip;
mod state;
mod thresholds;
mod tightened;

pub use estimator::GripEstimator;
pub use free::{FreeClose, FreeForce, NoFreeForce};
pub use state::{Grip, GripEstimate, GripState};
pub use thresholds::{GripThreshold, GripThresholds};
pub use tightened::{TightenCause, Tightened};
