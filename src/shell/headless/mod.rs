//! Pictures and lists of what is on screen, without a display, a GPU or a driver. No window and no command line here.

pub mod canvas;
pub mod cards;
pub mod driver;
pub mod labels;
pub mod png;
pub mod snap;
