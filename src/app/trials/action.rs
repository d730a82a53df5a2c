//! What the user may ask about grasp trials. Says nothing about how it is done.

use crate::app::trials::state::{SeriesKind, SessionId};
use crate::trials::search::SearchGoal;
use crate::trials::{Criterion, TrialPlan};
use std::path::PathBuf;

/// What the user asks for about trials.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum TrialAction {
    /// This is the plan now. Sends nothing.
    Plan(Box<TrialPlan>),
    /// Run a series, in the arming that is in force. Needs arming.
    Start(SeriesKind),
    /// Arm the hand, and run a series as soon as that holds.
    ArmAndStart(SeriesKind),
    /// This is the goal of the search now. Sends nothing.
    Goal(Box<SearchGoal>),
    /// Give a session this note.
    Note(SessionId, String),
    /// Give a session these tags, separated by commas.
    Tags(SessionId, String),
    /// Take a session out of the list; its files stay. What lies in no file is asked about first.
    Forget(SessionId),
    /// Yes, forget it without files too.
    ConfirmForget,
    /// No, it stays.
    CancelForget,
    /// Forget what trials measured of the hand that is shown.
    ForgetOvershoot,
    /// Save it as a table.
    ExportOvershoot,
    /// Read a saved session: one at a place that was typed, else one that is asked for.
    Open(Option<PathBuf>),
    /// Ask for a folder and save a session in a new one inside it; the report names the best by this.
    Save(SessionId, Option<Criterion>),
}
