//! The hands of the program: each a composition of its parts, and the list of them.

mod free_force;
pub mod grip;
pub mod hand;
pub mod list;
pub mod mover;
pub mod running;

#[cfg(test)]
mod news_tests;

pub use crate::app::hand::hand::Hand;
pub use crate::app::hand::mover::{Mover, rests};
