//! The exhibition shown in place of the window: its state as plain values, and the user's actions.

pub mod exhibit_file;
mod page;
pub mod stored_report;
pub(crate) mod wrong_pins_file;

#[cfg(test)]
mod stored_report_tests;

pub use crate::app::exhibit::stored_report::StoredReport;

use crate::app::env::running::Running;
use crate::app::settings::Language;
use crate::exhibit::pin::{Pin, PinAnswer, PinGate, WrongPins};
use crate::exhibit::plan::ExhibitPlan;
use crate::exhibit::stage::{ExhibitView, ExhibitWish};
use crate::hand::Moment;
use crate::motion::exhibit::{ExhibitProgress, PageDrawn};
use crate::store::Saver;
use std::sync::Arc;
use tokio::sync::mpsc;

/// An exhibition ready to be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Exhibition {
    /// Pieces, limits and texts of the exhibition.
    pub plan: Arc<ExhibitPlan>,
    /// Logo next to the title.
    pub logo: Option<Logo>,
    /// True if the program exits when the exhibition ends.
    pub ends_program: bool,
}

/// A picture with four bytes per pixel, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Logo {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Red, green, blue, opacity.
    pub rgba: Arc<[u8]>,
}

/// State of the staff panel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StaffPanel {
    /// Closed: visitors play.
    Closed,
    /// No PIN is set yet: staff choose one by typing it twice.
    Choose {
        /// First entry.
        first: Option<Pin>,
        /// True if the last entry was not a valid PIN, or differed from the first.
        refused: bool,
    },
    /// The PIN is requested.
    Ask {
        /// Result of the last entry.
        answer: Option<PinAnswer>,
        /// Time at which the panel closes.
        until: Moment,
    },
    /// The PIN was correct: staff can arm, disarm and leave.
    Open {
        /// Time at which the panel closes.
        until: Moment,
    },
}

/// User actions at an exhibition.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum ExhibitAction {
    /// Staff, in the window: start the built-in exhibition.
    Enter,
    /// Staff, in the window: ask for a file and start its exhibition.
    EnterFile,
    /// A visitor's request; arming and disarming are accepted only with the staff panel open.
    Wish(ExhibitWish),
    AskPin,
    /// A PIN was entered.
    Pin(String),
    /// Close the staff panel.
    CloseStaff,
    /// Leave the exhibition. Accepted only with the staff panel open.
    Leave,
}

/// A running exhibition.
#[derive(Debug)]
pub struct ExhibitState {
    /// Pieces, limits and texts of the exhibition.
    pub plan: Arc<ExhibitPlan>,
    /// Logo next to the title.
    pub logo: Option<Logo>,
    /// State of the visitors' page.
    pub view: ExhibitView,
    pub staff: StaffPanel,
    /// Today's counts and their file.
    pub report: StoredReport,
    pub(crate) gate: Option<PinGate>,
    /// File in which wrong PINs outlast a restart.
    pub(crate) wrong_pins: Saver<WrongPins>,
    pub(crate) ends_program: bool,
    /// Initial language for each visitor.
    pub(crate) language: Language,
    pub(crate) wishes: mpsc::Sender<ExhibitWish>,
    pub(crate) task: Running<ExhibitProgress, ()>,
    /// Time of the last drawing.
    pub(crate) drawn: Arc<PageDrawn>,
}
