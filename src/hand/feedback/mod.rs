//! What a hand reports: registers of one read as a sample, the readings, words and blocks in it.

pub mod fault;
pub mod group;
pub mod reading;
pub mod sample;
pub mod status;
pub mod tactile;
pub mod undocumented;
