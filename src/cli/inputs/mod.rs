//! What besides the window moves a hand, from the command line.

pub(crate) mod follow;
pub(crate) mod show;
mod source;
