//! Commands for recordings: recording without a window, and operations on the files.

pub(crate) mod beside;
pub(crate) mod export;
pub(crate) mod import;
pub(crate) mod info;
pub(crate) mod picture;
pub(crate) mod record;
pub(crate) mod recording_file;
pub(crate) mod replay;
