//! A CPU rasteriser for tessellated egui meshes, with the same bytes on each run. Independent of layout, files and the hand.

pub(crate) mod number;
pub(crate) mod surface;
pub(crate) mod texture;
pub(crate) mod tiles;
pub(crate) mod triangle;

pub use crate::raster::surface::{Changed, Raster};
