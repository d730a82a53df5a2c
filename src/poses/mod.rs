//! Poses, sequences and reactions: library, edits, files, shipped entries and playing. Sends nothing.

pub mod edit;
pub mod file;
mod grip_row;
pub mod library;
pub mod player;
pub mod preview;
pub mod reaction;
pub mod starter;
pub mod way;
pub mod wish;

pub use crate::poses::wish::{Play, Preset};

#[cfg(test)]
mod grip_tests;
#[cfg(test)]
mod hold_tests;
#[cfg(test)]
mod tests;
