//! The real window: with OpenGL, or without where there is none. Draws nothing itself; views live in `ui`.

mod dialog;
mod failure;
mod gl;
mod libraries;
mod program;
mod screen;
mod software;
mod start;

pub use failure::DesktopError;
pub use start::{DesktopStart, Drawing, run};
