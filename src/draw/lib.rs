//! Pictures computed point by point: the hand as a shaded figure, the lines of plots, and the rasteriser that draws egui's meshes
//! without OpenGL.
//! A separate crate, because it is optimised in tests too. `handscope` re-exports it.

pub mod figure;
pub mod plot_line;
pub mod raster;
