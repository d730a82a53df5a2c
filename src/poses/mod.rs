//! The person's own poses and sequences: library, edits, files, and how a sequence plays. Sends nothing.

pub mod edit;
pub mod file;
pub mod library;
pub mod player;
pub mod preview;

#[cfg(test)]
mod tests;
