//! A hand in a public exhibition: the file, the PIN, heat limits, and the course of events. Pure; sends nothing and reads no
//! clock.

pub mod file;
pub mod heat;
pub mod pin;
pub mod plan;
pub mod report;
pub mod stage;

#[cfg(test)]
mod file_tests;
