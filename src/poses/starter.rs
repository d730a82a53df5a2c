//! The shipped poses, sequences and reactions. They are read-only: the user copies or hides them.

use crate::poses::file;
use crate::poses::library::PoseLibrary;
use std::sync::LazyLock;

/// First id of shipped entries.
const FIRST_ID: u64 = 1 << 32;

static STARTER: LazyLock<PoseLibrary> = LazyLock::new(|| {
    let text = include_str!("../../assets/poses.toml");
    let read = file::read_into(PoseLibrary::numbered_after(FIRST_ID), text);
    debug_assert!(read.is_ok(), "{read:?}");
    read.unwrap_or_default()
});

/// The shipped library.
pub fn starter() -> &'static PoseLibrary {
    &STARTER
}
