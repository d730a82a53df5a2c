//! Feedback of a hand: registers that are read together form a sample of readings, status words and tactile blocks.

pub mod fault;
pub mod group;
pub mod reading;
pub mod sample;
pub mod status;
pub mod tactile;
pub mod undocumented;
