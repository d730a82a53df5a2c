//! Replay of a recording in place of the live hands, and operations on recordings.

pub(crate) mod player;
pub(crate) mod recorded;
pub(crate) mod work;
