//! Motion from sources other than the window: their targets, the checks on them, and following them with the hand.

pub mod dds;
pub mod fields;
pub mod intake;
pub mod line;
pub mod lines;
pub mod mirror;
pub mod offer;
pub mod pad;
pub mod scan;
pub mod stop;
pub mod stream;

pub use offer::{Offer, OfferLimits};
