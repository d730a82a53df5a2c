//! The palm: a lower shell with the motor of the thumb, a seam, an upper shell with a plate, and the wrist.

use crate::figure::shape::rings::{dome, frame, ring_at, rounded, step};
use crate::figure::solid::{LoftRing, Skin, Soup};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

const WRIST: [LoftRing; 3] = [
    [-13.0, -2.0, 20.4, 20.4, 24.0, 2.2],
    [-12.0, -2.0, 21.4, 21.4, 25.0, 2.2],
    [-4.6, -2.0, 21.4, 21.4, 25.0, 2.2],
];

const WRIST_RING: [LoftRing; 3] = [
    [-4.6, -2.0, 22.4, 22.4, 26.0, 2.2],
    [-1.6, -2.0, 22.4, 22.4, 26.0, 2.2],
    [-0.8, -2.0, 21.4, 21.4, 25.0, 2.2],
];

/// Up to the deck on which the thumb turns.
const LOWER: [LoftRing; 10] = [
    [1.4, -2.0, 16.5, 18.0, 24.0, 2.3],
    [3.0, -2.0, 17.5, 19.0, 26.0, 2.4],
    [9.0, -2.0, 17.2, 19.2, 30.0, 2.7],
    [16.0, -2.0, 17.0, 19.0, 34.0, 3.0],
    [24.0, -2.0, 16.8, 18.8, 37.4, 3.2],
    [31.0, -2.0, 16.6, 18.6, 39.4, 3.4],
    [45.0, -2.0, 16.3, 18.6, 41.7, 3.6],
    [51.0, -2.0, 16.2, 18.5, 42.2, 3.6],
    [DECK_MM - 1.6, -2.0, 16.1, 18.4, 42.7, 3.7],
    [DECK_MM, -2.0, 15.6, 17.9, 42.3, 3.7],
];

/// The groove between the shells.
const SEAM: [LoftRing; 2] = [
    [DECK_MM + 0.2, -2.0, 14.6, 17.0, 41.3, 3.7],
    [DECK_MM + 2.2, -2.0, 14.6, 17.0, 41.3, 3.7],
];

const UPPER: [LoftRing; 8] = [
    [DECK_MM + 2.4, -2.0, 15.6, 17.9, 42.4, 3.7],
    [DECK_MM + 3.6, -2.0, 16.0, 18.3, 43.0, 3.7],
    [78.0, -2.0, 15.5, 17.6, 43.7, 3.8],
    [98.0, -2.0, 14.9, 16.6, 44.0, 3.8],
    [116.0, -2.0, 14.3, 15.4, 43.8, 3.8],
    [131.0, -1.8, 13.5, 14.3, 43.5, 3.8],
    [139.5, -1.4, 12.2, 12.6, 43.0, 3.8],
    [143.6, -1.0, 10.2, 10.4, 42.0, 3.7],
];

const TOP: [LoftRing; 1] = [[145.2, -0.8, 7.8, 7.8, 40.2, 3.6]];

/// Height at which the lower shell ends and the thumb's foot sits.
const DECK_MM: f32 = 57.2;

/// Protrusion of the thumb's motor from the palm.
fn ball(at: Vec3) -> f32 {
    let along = step(0.0, 44.0, at.z) * step(DECK_MM + 0.2, DECK_MM, at.z);
    let edge = 1.0 - 0.07 * step(DECK_MM - 1.6, DECK_MM, at.z);
    let apart = ((at.x + 26.9) / 21.0).clamp(-1.0, 1.0);
    let across = (FRAC_PI_2 * apart).cos().max(0.0).powf(1.3);
    20.5 * along * edge * across * step(-12.0, 12.0, at.y)
}

/// Point of the palm's surface at a position across and along it.
fn surface(x: f32, z: f32) -> Vec3 {
    let rings: &[LoftRing] = if z < DECK_MM { &LOWER } else { &UPPER };
    let [_, rise, front, _, side, square] = ring_at(rings, z);
    let front = front * (1.0 - (x / side).abs().powf(square)).powf(1.0 / square);
    let at = Vec3::new(x, rise + front, z);
    at + Vec3::Y * ball(at)
}

/// Wrist, shells and seam.
pub(crate) fn palm(soup: &mut Soup) {
    let base = frame(Vec3::ZERO, Vec3::Z, Vec3::Y);
    let neck = [[1.2, -2.0, 19.0, 19.0, 22.6, 2.2]];
    soup.loft(
        &base,
        20,
        &[
            (Skin::Hinge, &WRIST),
            (Skin::Metal, &WRIST_RING),
            (Skin::Hinge, &neck),
        ],
    );
    // The little finger's knuckle is the lowest.
    let low = |at: Vec3| 2.8 * step(4.0, 44.0, at.x) * step(110.0, 145.0, at.z);
    let shells: [(Skin, &[LoftRing]); 4] = [
        (Skin::Metal, &LOWER),
        (Skin::Hinge, &SEAM),
        (Skin::Metal, &UPPER),
        (Skin::Hinge, &TOP),
    ];
    for shard in soup.loft(&base, 32, &shells) {
        let is_above = shard.skin == Skin::Hinge || shard.at.iter().all(|at| at.z > DECK_MM);
        if is_above && shard.at.iter().all(|at| at.y > 8.0) {
            // Under the plate, the lower shell's edge, and everything that touches it.
            shard.lift = -9.0;
        }
        shard.at = shard.at.map(|at| at + Vec3::new(0.0, ball(at), -low(at)));
    }
    if !soup.is_small {
        plate(soup);
        for [x, z] in [[-36.0, 135.0], [36.0, 133.0], [36.0, 66.5]] {
            screw(soup, x, z);
        }
    }
}

/// Steps of the plate in each direction, and the share of it within its dark rim.
const PLATE_STEPS: u8 = 8;
const WITHIN_RIM: f32 = 0.955;

fn plate(soup: &mut Soup) {
    let outermost = 1.0 - 2.0 / f32::from(PLATE_STEPS);
    let narrow = |share: f32| {
        let over = (share.abs() - outermost).max(0.0) / (1.0 - outermost);
        let within = share.abs().min(outermost) / outermost * WITHIN_RIM;
        (within + over * (1.0 - WITHIN_RIM)).copysign(share)
    };
    let place = |u: f32, v: f32| {
        let [u, v] = [narrow(u), narrow(v)];
        let [row, column] = rounded(u, v, 4.0);
        let at = surface(2.0 + column * 33.0, 100.0 + row * 33.5);
        at + Vec3::Y * dome(u, v, 0.7)
    };
    let steps = usize::from(PLATE_STEPS);
    for (number, shard) in soup
        .sheet(PLATE_STEPS, Skin::Plate, place)
        .iter_mut()
        .enumerate()
    {
        let (row, column) = (number / 2 / steps, number / 2 % steps);
        if [0, steps - 1].contains(&row) || [0, steps - 1].contains(&column) {
            shard.skin = Skin::Hinge;
        }
    }
}

fn screw(soup: &mut Soup, x: f32, z: f32) {
    let place = |u: f32, v: f32| {
        let [row, column] = rounded(u, v, 2.0).map(|share| share * SCREW_MM);
        surface(x + column, z + row) + Vec3::Y * 0.2
    };
    soup.sheet(4, Skin::Hinge, place);
}

const SCREW_MM: f32 = 2.1;
