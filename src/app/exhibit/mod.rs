//! The exhibition shown in place of the window: its contents and the user's actions.

pub mod exhibit_file;
mod page;
pub mod state;
pub mod stored_report;
pub(crate) mod wrong_pins_file;

#[cfg(test)]
mod stored_report_tests;

pub use crate::app::exhibit::state::{ExhibitAction, ExhibitState, Exhibition, Logo, StaffPanel};
pub use crate::app::exhibit::stored_report::StoredReport;
