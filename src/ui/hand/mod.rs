//! The drawn hand: a solid moved by the real kinematics, with the load on its fingertips.
//!
//! There is one mesh path: [`solid`] builds shapes once, [`shape`] holds their lengths, [`light`] and [`render`] turn them into
//! one plain mesh as seen by a [`camera`], so that OpenGL, the software window and pictures without a display show the same.
//! [`scene`] selects the parts to draw, [`view`] the viewpoint, [`tile`] caches small pictures; only [`panel`] knows the program's state.

pub(crate) mod aim;
pub(crate) mod figures;
mod finger_drag;
pub(crate) mod fingertip;
pub(crate) mod panel;
pub(crate) mod pointed;
mod scene;
#[cfg(test)]
mod tests;
pub(crate) mod tile;
mod view;
