//! Shapes apart from the hand: held objects, and the arrow of a force.

use crate::figure::shape::rings::{disc, frame};
use crate::figure::solid::{LoftRing, Skin, Solid, Soup};
use glam::{Affine3, Vec3};
use std::f32::consts::PI;
use std::sync::LazyLock;

/// Object in front of the simulated hand, drawn where the fingers touch it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    /// A soft ball.
    Ball,
    /// A hard block.
    Block,
    Cup,
}

/// Shape of a held object, in the palm's frame of a right hand.
pub fn held(held: Held) -> &'static Solid {
    static SHAPES: LazyLock<[Solid; 3]> = LazyLock::new(|| {
        let ball = |step: u8| (f32::from(step) / 24.0 * PI).sin_cos();
        let ball: [LoftRing; 25] = std::array::from_fn(|step| {
            let (sin, cos) = ball(u8::try_from(step).unwrap_or(0));
            disc(-cos * BALL_MM, (sin * BALL_MM).max(0.1))
        });
        let slab =
            |[along, less]: [f32; 2]| [along, 0.0, 24.0 - less, 24.0 - less, 28.0 - less, 14.0];
        let block = [-44.0, -42.5, -21.0, 0.0, 21.0, 42.5, 44.0];
        let block = block.map(|at: f32| slab([at, (at.abs() - 42.5).max(0.0)]));
        let cup = CUP.map(|[along, radius]| disc(along, radius));
        let tube = |rings: &[LoftRing], middle: [f32; 3], around: u8| {
            let mut soup = Soup::new(false);
            let base = frame(middle.into(), Vec3::X, Vec3::Y);
            soup.loft(&base, around, &[(Skin::Plain, rings)]);
            soup.solid()
        };
        [
            tube(&ball, [-5.0, 51.0, 131.0], 64),
            tube(&block, [-1.0, 38.5, 141.5], 64),
            tube(&cup, [-1.0, 43.0, 141.5], 64),
        ]
    });
    let [ball, block, cup] = &*SHAPES;
    match held {
        Held::Ball => ball,
        Held::Block => block,
        Held::Cup => cup,
    }
}

const BALL_MM: f32 = 35.5;

/// Position along the axis and radius, from the bottom over the brim to the visible part of the inside.
const CUP: [[f32; 2]; 9] = [
    [43.0, 24.0],
    [41.5, 25.5],
    [20.0, 26.5],
    [0.0, 27.2],
    [-20.0, 27.8],
    [-43.0, 28.5],
    [-44.0, 28.0],
    [-43.0, 27.0],
    [-26.0, 26.4],
];

/// An arrow of length 1 along y.
pub fn arrow() -> &'static Solid {
    static SHAPE: LazyLock<Solid> = LazyLock::new(|| {
        let mut soup = Soup::new(false);
        let rings = [
            disc(0.0, 0.045),
            disc(0.6, 0.045),
            disc(0.6, 0.13),
            disc(1.0, 0.004),
        ];
        soup.loft(&Affine3::IDENTITY, 10, &[(Skin::Plain, &rings)]);
        soup.solid()
    });
    &SHAPE
}
