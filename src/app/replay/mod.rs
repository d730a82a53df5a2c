//! A recording that is replayed in place of the live hands, and what is done with recordings.

pub(crate) mod beside;
pub(crate) mod player;
pub(crate) mod recorded;
pub(crate) mod work;
