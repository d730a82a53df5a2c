//! Grasp trials in the window: the plan being edited, the running series, sessions, and their files. Trials and their
//! metrics are defined in [`crate::trials`]. Draws nothing.

pub mod comparison;
#[cfg(test)]
pub(crate) mod comparison_tests;
pub(crate) mod files;
pub mod form;
pub mod overshoot;
pub mod state;
pub mod work;

pub use crate::app::trials::comparison::{
    ComparedLine, ComparedLines, ComparedRow, Comparison, LineGroup, RowKey, SessionDifference,
};
pub use crate::app::trials::overshoot::HandOvershoot;
pub use crate::app::trials::state::{
    JointLines, Search, SeriesKind, SeriesPlan, SessionId, SessionOrigin, SessionTrial,
    TrialAction, TrialQuantity, TrialSession, TrialsState,
};
pub use crate::app::trials::work::{SeriesRun, StartRefusal};
