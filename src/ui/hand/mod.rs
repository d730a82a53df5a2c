//! The drawn hand: a solid moved by the true kinematics, with what its fingertips feel.
//!
//! One mesh path for everything: [`solid`] builds shapes once, [`shape`] holds their lengths, [`light`] and [`render`] make
//! one plain mesh of them as a [`camera`] sees them, so that OpenGL, the software window and pictures without a display show the same. [`scene`] says
//! what is to be seen, [`view`] from where, [`tile`] keeps small pictures; [`panel`] alone knows the program's state.

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
