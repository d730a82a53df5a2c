//! Grasp trials on the simulated hand.

mod hidden;
mod series;
