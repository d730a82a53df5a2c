//! Readers of what is heard of a hand: faults and what happened around them, peaks, taring, friction.

pub mod fault_recorder;
pub mod faults;
pub(crate) mod friction;
pub mod pace;
pub mod peaks;
pub mod tare;
