//! The exhibition that is shown in place of the window: what it shows, what the user may do in it.

pub mod exhibit_file;
pub mod kept_report;
mod page;
pub mod state;
pub(crate) mod wrong_pins_file;

#[cfg(test)]
mod kept_report_tests;

pub use crate::app::exhibit::kept_report::KeptReport;
pub use crate::app::exhibit::state::{ExhibitAction, ExhibitState, Exhibition, Logo, StaffPanel};
