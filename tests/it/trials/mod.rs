//! Grasp trials on the simulated hand.

mod find;
mod hidden;
mod series;
mod virtual_hand;
