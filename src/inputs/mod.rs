//! Where motion comes from besides the window: what a source asks of a hand, how it is checked, and how the hand follows it.

pub mod offer;
pub mod pad;

pub use offer::Offer;
