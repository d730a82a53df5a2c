//! One hand: everything about it in one value, and what a person asks of it.

pub mod connection;
pub mod held_key;
mod hold_to_run;
pub mod joint;
pub mod motion;
pub mod mover;
pub mod news;
pub(crate) mod open;
pub mod play;
pub mod recording;
mod requests;
pub mod sequence;
pub mod slot;
pub mod state;
pub(crate) mod taring;

pub use crate::app::hand::joint::Preset;
pub use crate::app::hand::sequence::Play;
pub use crate::app::hand::state::{Freshness, HandState};
