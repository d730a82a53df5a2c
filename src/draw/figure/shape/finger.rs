//! The four fingers, and the parts that they share with the thumb: joints between forks, pads.

use crate::figure::shape::rings::{disc, dome, frame, ring_at, rounded};
use crate::figure::solid::{LoftRing, Skin, Soup, point};
use glam::{Affine3, Vec3};

/// Number of vertices around a finger.
const AROUND: u8 = 12;
/// Middle planes of the first and second segment.
const FIRST_MIDDLE_MM: f32 = -6.65;
const SECOND_MIDDLE_MM: f32 = -6.10;

const FIRST: [LoftRing; 5] = [
    [7.0, 0.9, 8.6, 8.4, 8.7, 3.4],
    [12.0, 1.5, 9.4, 9.0, 8.8, 3.4],
    [18.0, 2.0, 9.8, 9.1, 8.7, 3.4],
    [21.8, 2.4, 9.2, 8.8, 8.5, 3.4],
    [23.8, 2.6, 7.8, 7.8, 7.8, 3.4],
];

const SECOND: [LoftRing; 9] = [
    [8.8, 0.0, 7.8, 7.8, 7.8, 3.2],
    [12.0, 0.0, 8.5, 8.4, 8.6, 3.0],
    [24.0, 0.0, 8.6, 8.0, 8.7, 3.0],
    [36.0, 0.0, 8.7, 7.4, 8.5, 2.8],
    [44.0, 0.0, 8.6, 6.7, 8.0, 2.6],
    [49.0, 0.1, 7.7, 5.7, 7.0, 2.3],
    [52.6, 0.4, 5.9, 4.2, 5.5, 2.1],
    [54.8, 0.8, 3.4, 2.4, 3.3, 2.0],
    [55.7, 1.0, 1.0, 0.8, 1.0, 2.0],
];

/// The first segment of a finger, with the fork that holds the second.
pub(crate) fn first(soup: &mut Soup) {
    let base = frame(Vec3::Z * FIRST_MIDDLE_MM, Vec3::Y, Vec3::NEG_X);
    bone(soup, &base, [9.0, 9.2], (Skin::Metal, &FIRST));
    fork(soup, &base, [28.4, 2.9], [[11.6, 7.4], [6.7, 9.3]]);
}

/// The second segment of a finger: its length from joint to tip, and its thickness relative to the index finger's.
pub(crate) fn second(soup: &mut Soup, length: f32, thick: f32) {
    let stretch = |at: f32| 8.8 + (at - 8.8) * (length - 8.8) / (53.9 - 8.8);
    let rings = SECOND.map(|[along, rise, front, back, side, square]| {
        [
            stretch(along),
            rise,
            front * thick,
            back * thick,
            side * thick,
            square,
        ]
    });
    let base = frame(Vec3::Z * SECOND_MIDDLE_MM, Vec3::Y, Vec3::NEG_X);
    bone(soup, &base, [8.3, 6.6], (Skin::Rubber, &rings));
    pad(soup, &base, &rings, [stretch(32.0), stretch(54.6)]);
}

/// A segment with a rounded end at its joint: radius and half width of that end, then the remaining rings.
pub(crate) fn bone(
    soup: &mut Soup,
    base: &Affine3,
    [radius, side]: [f32; 2],
    rest: (Skin, &[LoftRing]),
) {
    let knuckle = [
        (-0.99, 0.14),
        (-0.8, 0.6),
        (-0.4, 0.92),
        (0.2, 0.98),
        (0.72, 0.86),
    ];
    let knuckle =
        knuckle.map(|(along, out)| [along * radius, 0.0, out * radius, out * radius, side, 5.0]);
    soup.loft(base, AROUND, &[(Skin::Hinge, &knuckle), rest]);
}

/// Two plates with pins that hold the next joint between them: the position of their centre, their half length and half height,
/// and the lateral distances of their inner and outer faces.
pub(crate) fn fork(
    soup: &mut Soup,
    base: &Affine3,
    [along, rise]: [f32; 2],
    [[long, high], [inner, outer]]: [[f32; 2]; 2],
) {
    for side in [base.matrix3.x_axis, -base.matrix3.x_axis] {
        let at = |along: f32| {
            let origin = base.transform_point3(Vec3::new(0.0, along, rise));
            frame(origin, side, base.matrix3.z_axis)
        };
        plate(soup, &at(along), [long, high], [inner, outer]);
        pin(soup, &at(along + long - high), outer);
    }
}

pub(crate) fn plate(
    soup: &mut Soup,
    base: &Affine3,
    [long, high]: [f32; 2],
    [inner, outer]: [f32; 2],
) {
    let tab = |at: f32, less: f32| [at, 0.0, high - less, high - less, long - less, 2.5];
    let rings = [tab(inner, 0.0), tab(outer - 0.7, 0.0), tab(outer, 0.9)];
    for shard in soup.loft(base, 14, &[(Skin::Metal, &rings)]) {
        shard.aside = base.matrix3.y_axis * 10.0;
    }
}

/// The end of a pin, flat on its plate.
pub(crate) fn pin(soup: &mut Soup, base: &Affine3, at: f32) {
    if soup.is_small {
        return;
    }
    let head = [disc(at, 3.2), disc(at + 0.3, 3.2)];
    for shard in soup.loft(base, 10, &[(Skin::Hinge, &head)]) {
        shard.aside = base.matrix3.y_axis * 24.0;
        if shard.area().normalize_or_zero().dot(base.matrix3.y_axis) < 0.9 {
            shard.at = [Vec3::ZERO; 3];
        }
    }
}

/// A sensor on the front of a fingertip, between two positions along it.
pub(crate) fn pad(soup: &mut Soup, base: &Affine3, rings: &[LoftRing], [from, to]: [f32; 2]) {
    let place = |u: f32, v: f32| {
        let [row, column] = rounded(u, v, 2.6);
        let ring = ring_at(rings, from + (to - from) * (row + 1.0) / 2.0);
        let under = point(&ring, 0.25 + column * 0.16);
        let out = Vec3::new(under.x, 0.0, under.z - ring[1]).normalize_or_zero();
        base.transform_point3(under + out * dome(u, v, 0.8))
    };
    for shard in soup.sheet(6, Skin::Pad, place) {
        shard.lift = 4.0;
    }
}
