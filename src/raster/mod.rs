//! A CPU rasteriser for tessellated egui meshes, same bytes on each run. Knows nothing of layout, files or the hand.

mod number;
mod surface;
mod texture;
mod triangle;

pub use surface::Raster;
