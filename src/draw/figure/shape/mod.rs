//! The shapes, modelled from the dimensions of the hand: lofts through rings in millimetres, each in the frame of its segment.

use crate::figure::solid::{Solid, Soup};
use glam::Vec3;
use handscope_core::hand::Finger;
use handscope_core::hand::kinematics::Segment;
use std::sync::LazyLock;

mod finger;
mod held;
mod palm;
pub(crate) mod rings;
mod thumb;

pub use held::{Held, HeldPlace, arrow};

use Segment::{Index1, Index2, Little2, Middle2, Palm, Thumb1, Thumb2, Thumb3, Thumb4};

/// The shapes of the hand, each built once; the second set is for small pictures.
static SHAPES: [LazyLock<Vec<(Segment, Solid)>>; 2] = [
    LazyLock::new(|| models(false)),
    LazyLock::new(|| models(true)),
];

fn models(is_small: bool) -> Vec<(Segment, Solid)> {
    let model = |segment| (segment, model(segment, is_small));
    Segment::ALL.into_iter().map(model).collect()
}

fn model(segment: Segment, is_small: bool) -> Solid {
    let mut soup = Soup::new(is_small);
    match segment {
        Palm => palm::palm(&mut soup),
        Thumb1 => thumb::foot(&mut soup),
        Thumb2 => thumb::second(&mut soup),
        Thumb3 => thumb::third(&mut soup),
        Thumb4 => thumb::fourth(&mut soup),
        Little2 => finger::second(&mut soup, 43.8, 0.88),
        Middle2 => finger::second(&mut soup, 57.6, 1.02),
        Segment::Ring2 | Index2 => finger::second(&mut soup, 53.9, 1.0),
        Segment::Little1 | Segment::Ring1 | Segment::Middle1 | Index1 => finger::first(&mut soup),
    }
    soup.solid()
}

pub fn solid(segment: Segment, is_small: bool) -> Option<&'static Solid> {
    let [large, small] = &SHAPES;
    let mut all = if is_small { small } else { large }.iter();
    all.find(|(own, _)| *own == segment).map(|(_, solid)| solid)
}

/// Directions out of a fingertip's pad, and along it to the tip, in the frame of [`Segment::tip`].
pub const fn pad_ways(finger: Finger) -> [Vec3; 2] {
    match finger {
        Finger::Thumb => [Vec3::new(-0.176, 0.984, 0.0), Vec3::new(0.984, 0.176, 0.0)],
        _ => [Vec3::NEG_X, Vec3::Y],
    }
}
