//! What besides the window moves a hand, from the command line.

mod consent;
pub(crate) mod follow;
pub(crate) mod show;
mod source;
