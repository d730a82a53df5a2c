//! Programs that move an armed hand over time. Each motion is a [`Program`](program::Program), a pure state machine: readings, time
//! and user input in, orders out. [`drive`](drive::drive) is the one loop that runs them and owns the safety rules.
#![warn(missing_docs)]

pub mod checkup;
pub mod drive;
pub mod exhibit;
pub mod follow;
pub mod grasp;
pub mod grip;
pub mod held_object;
pub mod hold;
mod hold_finger;
mod hosted_hold;
pub mod move_to;
mod pinch;
pub mod play;
pub mod program;
pub mod scale;
pub mod series;
pub mod source;
#[cfg(test)]
mod tests;
