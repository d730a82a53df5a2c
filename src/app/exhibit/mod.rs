//! The exhibition that is shown in place of the window: what it shows, what a person may do in it.

pub mod state;
mod work;

pub use crate::app::exhibit::state::{ExhibitAction, ExhibitStart, ExhibitState, Logo, StaffPanel};
