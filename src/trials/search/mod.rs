//! Search for the fastest close with its peak under a limit: goal, search and result. Runs nothing.
//!
//! [`goal`] is the user's request; [`settings_search`] chooses close after close, from the facts that [`close`] extracts from each
//! recording, the closes of each joint together, the growth of the peak with the speed ([`growth`]), and the reference
//! of the drive's threshold ([`offset`]); [`tolerance`] quantifies the confidence of a
//! bound; [`finding`] is the claim, or the reason for its absence.

pub mod close;
mod confirm;
pub mod finding;
pub mod goal;
pub mod growth;
mod joint;
#[cfg(test)]
mod late_stops;
pub mod offset;
pub mod peak;
pub mod settings_search;
pub mod tolerance;

pub use crate::trials::search::finding::{
    Claim, ComparedThreshold, Finding, FoundApproach, JointClaim, NoClaim, OpenQuestion,
    SearchProgress, SearchStage, Tried,
};
pub use crate::trials::search::goal::{GoalError, SearchGoal};
pub use crate::trials::search::offset::ThresholdReference;
pub use crate::trials::search::settings_search::{NextClose, SettingsSearch};
pub use crate::trials::search::tolerance::Assurance;
