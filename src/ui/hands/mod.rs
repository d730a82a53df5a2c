//! Several hands in one window: their strips below the header, and all of them side by side.
pub(crate) mod beside;
pub(crate) mod strips;
