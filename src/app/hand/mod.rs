//! The parts of one hand. Each owns its state and is independent of the others; `hands` composes them.

pub mod activity;
pub mod connection;
pub mod controls;
mod held_key;
pub mod sequence;
pub(crate) mod status_news;

pub use crate::app::hand::activity::Activity;
pub(crate) use crate::app::hand::activity::RecordedMover;
pub use crate::app::hand::connection::Connection;
pub use crate::app::hand::controls::{Controls, JointControl};
pub use crate::app::hand::held_key::HoldKey;
pub use crate::app::hand::sequence::SequenceRun;
