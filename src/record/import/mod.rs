//! Recordings out of what others can write. What such a file does not say stays unknown.

pub mod csv;
mod lines;
