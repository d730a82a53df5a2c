//! The window against hand-made states. No hand, no link.

mod controls;
mod places;
mod plots;
