//! Shapes apart from the hand: held objects, and the arrow of a force.

use crate::figure::shape::pad_ways;
use crate::figure::shape::rings::{disc, frame};
use crate::figure::solid::{LoftRing, Skin, Solid, Soup};
use glam::{Affine3, Quat, Vec3};
use handscope_core::hand::kinematics::{Segment, SegmentFrames, Side};
use handscope_core::hand::{Finger, PerDof};
use std::f32::consts::PI;
use std::sync::LazyLock;

/// Shape of an object in front of the simulated hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Held {
    Ball,
    Block,
    Cup,
    /// A tube or a can.
    Tube,
}

/// An object where the fingers touch it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldPlace {
    pub shape: Held,
    /// Place and size of the shape in the palm's frame of a right hand.
    pub frame: Affine3,
}

impl HeldPlace {
    /// An object of this thickness where the fingers touch it, at these angles, 0 (bent) to 1000 (open); joints that miss it
    /// have none.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a picture needs single precision"
    )]
    pub fn touched(shape: Held, thickness_mm: f64, angles: &PerDof<Option<f64>>) -> Self {
        let thickness_mm = thickness_mm as f32;
        let shares = angles.map(|angle| angle.map_or(1.0, |angle| angle as f32 / 1000.0));
        let pose = SegmentFrames::of_shares(Side::Right, &shares);
        let radius = thickness_mm / 2.0 + PAD_MM;
        let fingers = [Finger::Little, Finger::Ring, Finger::Middle, Finger::Index];
        let mut pads = fingers.map(|finger| pose.tip(finger));
        if shape == Held::Block {
            // A flat face lies at the lowest pad.
            let lowest = pads.into_iter().fold(f32::MAX, |low, pad| low.min(pad.z));
            pads = pads.map(|pad| pad.with_z(lowest));
        }
        let outs = fingers.map(|finger| {
            let [out, _] = pad_ways(finger);
            pose.frame(Segment::tip(finger)).matrix3 * out
        });
        let [little, _, _, index] = pads;
        // A ball that is narrower than the hand lies where thumb and index take it.
        let is_small = shape == Held::Ball && 2.0 * radius < (little.x - index.x).abs();
        let touches = [!is_small, !is_small, true, true];
        let mean = |all: [Vec3; 4]| {
            let all = all.into_iter().zip(touches).filter(|(_, touches)| *touches);
            let add = |(sum, count), (at, _)| (sum + at, count + 1.0);
            let (sum, count) = all.fold((Vec3::ZERO, 0.0_f32), add);
            sum / count
        };
        let mut middle = mean(pads) + mean(outs).normalize_or_zero() * radius;
        for _ in 0..FIT_STEPS {
            // Each finger that touches it wants its pad on the surface.
            middle = mean(pads.map(|pad| {
                let towards = match shape {
                    Held::Ball => middle - pad,
                    Held::Cup | Held::Tube => (middle - pad) * (Vec3::Y + Vec3::Z),
                    Held::Block => Vec3::NEG_Z,
                };
                pad + towards.normalize_or_zero() * radius
            }));
        }
        let scale = Vec3::splat(thickness_mm / shape.thickness_mm());
        let frame = Affine3::from_scale_rotation_translation(scale, Quat::IDENTITY, middle);
        Self { shape, frame }
    }
}

/// Distance of a surface from the centre of the pad that touches it: the tip is lower around it.
const PAD_MM: f32 = 2.0;
/// Steps after which the place of an object no longer changes.
const FIT_STEPS: usize = 12;

impl Held {
    /// Thickness of the shape between the fingers.
    pub const fn thickness_mm(self) -> f32 {
        match self {
            Self::Ball => 2.0 * BALL_MM,
            Self::Block => 2.0 * BLOCK_MM,
            Self::Cup => 2.0 * CUP_MM,
            Self::Tube => 2.0 * TUBE_MM,
        }
    }

    /// The shape around the origin, its axis along x.
    pub fn solid(self) -> &'static Solid {
        static SHAPES: LazyLock<[Solid; 4]> = LazyLock::new(|| {
            let ball = |step: u8| (f32::from(step) / 24.0 * PI).sin_cos();
            let ball: [LoftRing; 25] = std::array::from_fn(|step| {
                let (sin, cos) = ball(u8::try_from(step).unwrap_or(0));
                disc(-cos * BALL_MM, (sin * BALL_MM).max(0.1))
            });
            let slab = |[along, less]: [f32; 2]| {
                let half = BLOCK_MM - less;
                [along, 0.0, half, half, half + 4.0, 14.0]
            };
            let block = [-34.0, -32.5, -16.0, 0.0, 16.0, 32.5, 34.0];
            let block = block.map(|at: f32| slab([at, (at.abs() - 32.5).max(0.0)]));
            let tubes = [CUP.as_slice(), &TUBE].map(|rings| {
                let rings = rings.iter().map(|[along, radius]| disc(*along, *radius));
                rings.collect::<Vec<LoftRing>>()
            });
            let [cup, tube] = &tubes;
            [ball.as_slice(), &block, cup, tube].map(|rings| {
                let mut soup = Soup::new(false);
                let base = frame(Vec3::ZERO, Vec3::X, Vec3::Y);
                soup.loft(&base, 64, &[(Skin::Plain, rings)]);
                soup.solid()
            })
        });
        let [ball, block, cup, tube] = &*SHAPES;
        match self {
            Self::Ball => ball,
            Self::Block => block,
            Self::Cup => cup,
            Self::Tube => tube,
        }
    }
}

/// Half of the thickness of each shape.
const BALL_MM: f32 = 35.5;
const BLOCK_MM: f32 = 24.0;
const CUP_MM: f32 = 27.2;
const TUBE_MM: f32 = 25.0;

/// Position along the axis and radius, from the bottom over the brim to the visible part of the inside.
const CUP: [[f32; 2]; 9] = [
    [35.0, 24.0],
    [33.5, 25.5],
    [16.0, 26.5],
    [0.0, 27.2],
    [-16.0, 27.8],
    [-35.0, 28.5],
    [-36.0, 28.0],
    [-35.0, 27.0],
    [-21.0, 26.4],
];

/// As [`CUP`], closed at both ends.
const TUBE: [[f32; 2]; 6] = [
    [36.0, 0.1],
    [36.0, 24.0],
    [34.5, 25.0],
    [-34.5, 25.0],
    [-36.0, 24.0],
    [-36.0, 0.1],
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
