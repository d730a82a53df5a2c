//! Commands that need no hand: help, registers, the hand as a model, and what packages and shells take.

pub(crate) mod help;
pub(crate) mod model;
pub(crate) mod packaging;
pub(crate) mod registers;
