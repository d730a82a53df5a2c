//! Sources other than the window that move a hand, from the command line.

pub(crate) mod follow;
pub(crate) mod show;
mod source;
