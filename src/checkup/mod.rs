//! A check-up of an empty hand: each joint runs through its stroke alone, gently, and the readings are compared with those measured
//! on other hands of the family and with this hand's own first check-up. Sends nothing itself.

pub mod check;
pub mod free_file;
pub mod hand_file;
pub mod kept;
mod measure;
pub mod newtons_file;
pub mod report;
pub mod run;
mod steps;
pub mod subject;
mod tips;
pub mod trend;
pub mod usage;

pub use crate::checkup::check::Check;
pub use crate::checkup::measure::Measured;
pub use crate::checkup::run::Checkup;
pub use crate::checkup::steps::{CheckupPlan, expected};
pub use crate::checkup::subject::{Grade, HandPart, Subject};
pub use crate::checkup::tips::ChannelSet;
