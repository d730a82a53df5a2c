//! Rings and frames of lofts, and the layout of patches on them.

use crate::figure::solid::LoftRing;
use glam::{Affine3, Vec3};

/// Maps a square to a superellipse: shares from -1 to 1 stay inside a ring of exponent `square`.
pub(crate) fn rounded(u: f32, v: f32, square: f32) -> [f32; 2] {
    let most = u.abs().max(v.abs()).max(1e-6);
    let out = ((u / most).abs().powf(square) + (v / most).abs().powf(square)).max(1.0);
    [u, v].map(|part| part * out.powf(-1.0 / square))
}

/// Height of a patch above its surface: a low dome whose rim is below the surface.
pub(crate) fn dome(u: f32, v: f32, high: f32) -> f32 {
    (high + 0.15) * (1.0 - u.abs().max(v.abs()).powi(6)) - 0.15
}

/// The interpolated ring of a loft at a position along it.
pub(crate) fn ring_at(rings: &[LoftRing], along: f32) -> LoftRing {
    let pair = rings
        .windows(2)
        .rev()
        .find(|pair| matches!(pair, [[at, ..], _] if *at <= along));
    let Some([one, two]) = pair else {
        return rings.first().copied().unwrap_or_default();
    };
    let part = ((along - one[0]) / (two[0] - one[0])).min(1.0);
    let mut ring = *one;
    ring.iter_mut()
        .zip(two)
        .for_each(|(one, two)| *one += (two - *one) * part);
    ring
}

/// A frame whose y points along a loft and whose z points to its front.
pub(crate) fn frame(origin: Vec3, along: Vec3, front: Vec3) -> Affine3 {
    Affine3::from_cols(along.cross(front), along, front, origin)
}

pub(crate) const fn disc(along: f32, radius: f32) -> LoftRing {
    [along, 0.0, radius, radius, radius, 2.0]
}

/// Smoothstep from 0 to 1 between two values.
pub(crate) fn step(from: f32, to: f32, at: f32) -> f32 {
    let part = ((at - from) / (to - from)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}
