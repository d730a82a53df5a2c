//! What an exhibition shows, as plain values, and what the user may do in it.

use crate::app::env::running::Running;
use crate::app::exhibit::kept_report::KeptReport;
use crate::app::settings::Language;
use crate::exhibit::pin::{Pin, PinAnswer, PinGate, WrongPins};
use crate::exhibit::plan::ExhibitPlan;
use crate::exhibit::run::{ExhibitView, ExhibitWish};
use crate::hand::Moment;
use crate::store::Saver;
use crate::tasks::exhibit::{ExhibitStep, PageDrawn};
use std::sync::Arc;
use tokio::sync::mpsc;

/// An exhibition that is ready to be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Exhibition {
    /// What may be played.
    pub plan: Arc<ExhibitPlan>,
    /// What stands beside its title.
    pub logo: Option<Logo>,
    /// The program ends with it.
    pub ends_program: bool,
}

/// A picture: four bytes a pixel, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Logo {
    /// Pixels a row, and rows.
    pub size: [usize; 2],
    /// Red, green, blue, opacity.
    pub rgba: Arc<[u8]>,
}

/// What staff see of the page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StaffPanel {
    /// Nothing: visitors play.
    Closed,
    /// Nobody chose a PIN yet: they do so, typing it twice.
    Choose {
        /// What was typed first.
        first: Option<Pin>,
        /// What was typed was no PIN, or not the same one.
        refused: bool,
    },
    /// The PIN is asked for, by this moment at most.
    Ask {
        /// What became of the last one.
        answer: Option<PinAnswer>,
        /// Then it closes.
        until: Moment,
    },
    /// The PIN was right: arm, disarm, leave, until this moment at most.
    Open {
        /// Then it closes.
        until: Moment,
    },
}

/// What the user does at an exhibition.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum ExhibitAction {
    /// Staff, in the window: show the exhibition that is built in.
    Enter,
    /// Staff, in the window: show the one of a file that is asked for.
    EnterFile,
    /// What visitors do; arming and disarming passes with the staff panel open only.
    Wish(ExhibitWish),
    AskPin,
    /// This was typed.
    Pin(String),
    /// Close what staff see.
    CloseStaff,
    /// Leave the exhibition. Passes with the staff panel open only.
    Leave,
}

/// An exhibition that goes on.
#[derive(Debug)]
pub struct ExhibitState {
    /// What may be played.
    pub plan: Arc<ExhibitPlan>,
    /// What stands beside its title.
    pub logo: Option<Logo>,
    /// What the visitors' page shows.
    pub view: ExhibitView,
    /// What staff see.
    pub staff: StaffPanel,
    /// What was counted today, and its file.
    pub report: KeptReport,
    pub(crate) gate: Option<PinGate>,
    /// The file that keeps wrong PINs over a restart.
    pub(crate) wrong_pins: Saver<WrongPins>,
    pub(crate) ends_program: bool,
    /// The language that it begins with for each visitor.
    pub(crate) language: Language,
    pub(crate) wishes: mpsc::Sender<ExhibitWish>,
    pub(crate) task: Running<ExhibitStep, ()>,
    /// When it was drawn last.
    pub(crate) drawn: Arc<PageDrawn>,
}
