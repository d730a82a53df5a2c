//! The exhibition shown in place of the window: its contents and the user's actions.

pub mod exhibit_file;
pub mod kept_report;
mod page;
pub mod state;
pub(crate) mod wrong_pins_file;

#[cfg(test)]
mod kept_report_tests;

pub use crate::app::exhibit::kept_report::KeptReport;
pub use crate::app::exhibit::state::{ExhibitAction, ExhibitState, Exhibition, Logo, StaffPanel};
