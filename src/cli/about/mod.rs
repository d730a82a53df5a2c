//! Commands that need no hand: help, registers, models of the hand, and files for packages and shells.

pub(crate) mod help;
pub(crate) mod model;
pub(crate) mod packaging;
pub(crate) mod registers;
