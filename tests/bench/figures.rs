//! Figures of speed.
fn main() {}
