//! The real window, with or without OpenGL. Draws nothing itself; views live in `ui`.

pub(crate) mod card;
pub(crate) mod dialog;
pub(crate) mod failure;
pub(crate) mod file_manager;
pub(crate) mod gl;
pub(crate) mod icon;
pub(crate) mod libraries;
pub(crate) mod options;
pub(crate) mod placing;
pub(crate) mod program;
pub(crate) mod screen;
pub(crate) mod shutdown;
pub(crate) mod software;
pub(crate) mod start;

pub use crate::shell::desktop::card::may_draw_with_a_card;
pub use crate::shell::desktop::failure::DesktopError;
pub use crate::shell::desktop::options::{DesktopStart, Renderer};
pub use crate::shell::desktop::start::run;
