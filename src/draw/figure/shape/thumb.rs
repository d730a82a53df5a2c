//! The thumb: its foot that turns on the palm, and three segments.

use crate::figure::shape::finger::{bone, fork, pad, pin, plate};
use crate::figure::shape::rings::{disc, frame};
use crate::figure::solid::{LoftRing, Skin, Soup};
use glam::{Affine3, Vec3};

/// Middle plane of the thumb.
const MIDDLE_MM: f32 = -7.2;

const SECOND: [LoftRing; 6] = [
    [8.6, 1.0, 9.2, 9.2, 9.6, 3.2],
    [12.0, 1.6, 12.0, 10.6, 10.4, 3.0],
    [17.0, 2.0, 13.6, 11.0, 10.8, 3.0],
    [22.0, 1.9, 13.2, 10.6, 10.7, 3.0],
    [26.4, 0.8, 10.6, 9.4, 10.0, 3.0],
    [28.2, 0.6, 8.6, 8.2, 9.0, 3.0],
];

const THIRD: [LoftRing; 4] = [
    [8.0, 0.0, 8.8, 8.8, 9.0, 3.2],
    [11.0, 0.2, 9.4, 9.2, 9.6, 3.2],
    [14.6, 0.2, 9.2, 9.0, 9.4, 3.2],
    [16.4, 0.0, 7.8, 7.8, 8.4, 3.2],
];

const FOURTH: [LoftRing; 9] = [
    [8.4, 0.4, 8.2, 8.2, 8.4, 3.0],
    [11.0, 0.6, 8.9, 8.8, 9.2, 2.9],
    [17.0, 0.6, 9.0, 8.6, 9.3, 2.8],
    [22.5, 0.1, 9.0, 8.0, 9.1, 2.7],
    [27.5, -0.6, 8.6, 7.1, 8.4, 2.5],
    [31.5, -1.2, 7.3, 5.8, 7.2, 2.3],
    [34.6, -1.7, 5.3, 4.0, 5.3, 2.1],
    [36.4, -2.0, 3.0, 2.2, 3.1, 2.0],
    [37.1, -2.1, 0.9, 0.7, 0.9, 2.0],
];

/// The frame of a segment whose next joint, or tip, is in this direction.
fn base(x: f32, y: f32) -> Affine3 {
    let along = Vec3::new(x, y, 0.0).normalize();
    frame(Vec3::Z * MIDDLE_MM, along, Vec3::Z.cross(along))
}

/// The second segment, which bends on the foot.
pub(crate) fn second(soup: &mut Soup) {
    let base = base(31.403, 21.069);
    bone(soup, &base, [10.4, 9.0], (Skin::Metal, &SECOND));
    fork(soup, &base, [32.6, 0.2], [[12.4, 7.4], [8.2, 10.5]]);
}

pub(crate) fn third(soup: &mut Soup) {
    let base = base(21.903, 12.816);
    bone(soup, &base, [9.4, 8.0], (Skin::Metal, &THIRD));
    fork(soup, &base, [20.8, 0.0], [[11.6, 7.2], [7.4, 9.6]]);
}

/// The fourth segment, with the tip.
pub(crate) fn fourth(soup: &mut Soup) {
    let base = base(0.93, 0.3676);
    bone(soup, &base, [8.9, 7.2], (Skin::Rubber, &FOURTH));
    pad(soup, &base, &FOURTH, [13.0, 35.0]);
}

/// The foot: a drum on the deck of the palm, with the fork of the first bending joint.
pub(crate) fn foot(soup: &mut Soup) {
    let drum = [disc(-11.4, 13.2), disc(-9.9, 13.2)];
    let collar = [disc(-9.6, 12.0), disc(-7.8, 12.0), disc(-7.2, 11.2)];
    let neck = [[-6.0, 3.0, 9.0, 9.0, 9.0, 2.0]];
    let base = frame(Vec3::ZERO, Vec3::Z, Vec3::NEG_X);
    let bands: [(Skin, &[LoftRing]); 3] = [
        (Skin::Hinge, &drum),
        (Skin::Metal, &collar),
        (Skin::Hinge, &neck),
    ];
    soup.loft(&base, 16, &bands);
    let axis = Vec3::new(0.2588, 0.9659, 0.0);
    let middle = Vec3::new(-7.925, 9.06, 5.2) + axis * MIDDLE_MM;
    for side in [axis, -axis] {
        let up = axis.cross(Vec3::Z);
        let low = frame(middle - Vec3::Z * 2.6, side, up);
        plate(soup, &low, [11.6, 8.2], [9.1, 11.3]);
        pin(soup, &frame(middle, side, up), 11.3);
    }
}
