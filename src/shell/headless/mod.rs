//! Pictures and label lists of the screen, without a display, a GPU or a driver. No window and no command line here.

pub mod canvas;
pub mod cards;
pub mod driver;
pub mod labels;
pub mod png;
pub mod snap;
