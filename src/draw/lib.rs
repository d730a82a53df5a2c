//! What computes pictures point by point: the hand as a shaded figure, the lines of plots, and the rasteriser that draws egui's
//! meshes without OpenGL.
//! A crate of its own, for it is optimised in tests too. `handscope` hands it on.

pub mod figure;
pub mod plot_line;
pub mod raster;
