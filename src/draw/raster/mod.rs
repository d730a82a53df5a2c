//! A CPU rasteriser for tessellated egui meshes, same bytes on each run. Knows nothing of layout, files or the hand.

pub(crate) mod number;
pub(crate) mod surface;
pub(crate) mod texture;
pub(crate) mod tiles;
pub(crate) mod triangle;

pub use crate::raster::surface::{Changed, Raster};
