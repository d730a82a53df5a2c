//! Finding the fastest close whose peak stays under a limit: the wish, the search, and what it came to. Runs nothing.
//!
//! [`wish`] is what a person wants; [`finder`] chooses close after close, from what [`close`] reads out of each recording,
//! what a joint's closes say together, and how the peak grows with the speed ([`growth`]); [`tolerance`] is how sure a bound
//! is; [`finding`] is the claim, or why there is none.

pub mod close;
mod confirm;
pub mod finder;
pub mod finding;
pub mod growth;
mod joint;
pub mod tolerance;
pub mod wish;

pub use crate::trials::find::finder::{Finder, NextClose};
pub use crate::trials::find::finding::{
    Claim, FindProgress, FindStage, Finding, FoundApproach, JointClaim, NoClaim, Tried, Untold,
};
pub use crate::trials::find::tolerance::Assurance;
pub use crate::trials::find::wish::{TuneWish, WishError};
