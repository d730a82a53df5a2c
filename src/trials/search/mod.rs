//! Finding the fastest close whose peak stays under a limit: the goal, the search, and what it came to. Runs nothing.
//!
//! [`goal`] is what the user wants; [`settings_search`] chooses close after close, from what [`close`] reads out of each recording,
//! what a joint's closes say together, and how the peak grows with the speed ([`growth`]), and what the
//! drive compares its threshold with ([`offset`]); [`tolerance`] is how sure a bound
//! is; [`finding`] is the claim, or why there is none.

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
    Claim, ComparedThreshold, Finding, FoundApproach, JointClaim, NoClaim, SearchProgress,
    SearchStage, Tried, Untold,
};
pub use crate::trials::search::goal::{GoalError, SearchGoal};
pub use crate::trials::search::offset::Compared;
pub use crate::trials::search::settings_search::{NextClose, SettingsSearch};
pub use crate::trials::search::tolerance::Assurance;
