//! Grasp trials on the simulated hand.

mod checkup;
mod hidden;
mod hold;
mod other_hand;
mod scale;
mod search;
mod series;
mod virtual_hand;
mod worn;
