//! Everything the program knows, without drawing.

pub mod action;
pub mod faults;
pub mod gestures;
pub mod history;
pub mod notices;
pub mod settings;
pub mod state;
