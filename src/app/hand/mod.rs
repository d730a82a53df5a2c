//! One hand: everything about it in one value, and what a person asks of it.

pub mod connection;
pub mod gestures;
pub mod joint;
pub mod motion;
pub mod mover;
pub mod news;
pub(crate) mod open;
pub(crate) mod pending;
pub mod play;
pub mod preset;
pub mod requests;
pub mod sequence;
pub mod state;
pub(crate) mod taring;

pub use crate::app::hand::preset::Preset;
pub use crate::app::hand::sequence::Play;
pub use crate::app::hand::state::{Freshness, HandState};
