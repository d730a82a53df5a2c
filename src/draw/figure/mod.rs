//! The hand as a shaded figure: solids for each segment, a camera, lamps and materials, one mesh for egui. Independent of themes
//! and panels.

mod bars;
pub mod camera;
pub mod light;
pub mod render;
pub mod shape;
pub mod solid;
pub mod studio;
