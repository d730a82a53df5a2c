//! Layout of the drawn gamepad, in its own units: the origin is the middle of the pad, and positive y is down.

use crate::inputs::pad::PadControl;
use egui::{Pos2, Rect, Vec2, pos2, vec2};

/// Extent of the drawing.
pub(crate) const CANVAS: Rect = Rect {
    min: pos2(-202.0, -152.0),
    max: pos2(202.0, 144.0),
};
/// Radius of a face button.
pub(crate) const FACE: f32 = 14.0;
/// Radius of a stick's well, and of its cap.
pub(crate) const WELL: f32 = 31.0;
pub(crate) const CAP: f32 = 15.0;
/// Travel of a cap.
pub(crate) const CAP_WAY: f32 = 8.0;
/// Distance of a face button from the middle of the four.
const FACE_WAY: f32 = 28.0;
const FACES: Vec2 = vec2(106.0, -24.0);
const CROSS: Vec2 = vec2(-50.0, 30.0);
/// Half the width of an arm of the cross.
const ARM: f32 = 9.0;
/// Length of an arm from the middle.
const ARM_WAY: f32 = 27.0;

/// Corners of the right half of the body, from top to bottom, before rounding.
const HALF: [[f32; 2]; 15] = [
    [0.0, -80.0],
    [62.0, -80.0],
    [120.0, -84.0],
    [156.0, -82.0],
    [173.0, -50.0],
    [184.0, 10.0],
    [196.0, 78.0],
    [200.0, 124.0],
    [180.0, 146.0],
    [150.0, 138.0],
    [126.0, 106.0],
    [108.0, 84.0],
    [84.0, 76.0],
    [56.0, 74.0],
    [0.0, 74.0],
];
/// Number of corner-cutting passes.
const ROUNDED: u8 = 3;

/// Bounding rectangle of a control.
pub(crate) fn place(control: PadControl) -> Rect {
    let face = |way: Vec2| square(FACES + FACE_WAY * way, FACE);
    let (middle, size) = match control {
        PadControl::South => return face(Vec2::DOWN),
        PadControl::East => return face(Vec2::RIGHT),
        PadControl::West => return face(Vec2::LEFT),
        PadControl::North => return face(Vec2::UP),
        PadControl::LeftBumper => (vec2(-114.0, -90.0), vec2(84.0, 22.0)),
        PadControl::RightBumper => (vec2(114.0, -90.0), vec2(84.0, 22.0)),
        PadControl::LeftTrigger => (vec2(-116.0, -127.0), vec2(62.0, 44.0)),
        PadControl::RightTrigger => (vec2(116.0, -127.0), vec2(62.0, 44.0)),
        PadControl::LeftStick => return square(vec2(-106.0, -24.0), WELL),
        PadControl::RightStick => return square(vec2(50.0, 32.0), WELL),
        PadControl::LeftStickPress => (vec2(-142.0, 22.0), vec2(30.0, 20.0)),
        PadControl::RightStickPress => (vec2(103.0, 48.0), vec2(30.0, 20.0)),
        PadControl::DpadUp => return arm(Vec2::UP),
        PadControl::DpadDown => return arm(Vec2::DOWN),
        PadControl::DpadLeft => return arm(Vec2::LEFT),
        PadControl::DpadRight => return arm(Vec2::RIGHT),
        PadControl::Select => (vec2(-32.0, -26.0), vec2(26.0, 15.0)),
        PadControl::Start => (vec2(32.0, -26.0), vec2(26.0, 15.0)),
        PadControl::Home => return square(vec2(0.0, -52.0), 13.0),
    };
    Rect::from_center_size(middle.to_pos2(), size)
}

/// The middle of the cross, which does not react.
pub(crate) fn cross_middle() -> Rect {
    square(CROSS, ARM)
}

fn square(middle: Vec2, half: f32) -> Rect {
    Rect::from_center_size(middle.to_pos2(), Vec2::splat(2.0 * half))
}

fn arm(way: Vec2) -> Rect {
    let near = CROSS + way * (ARM + 0.5);
    let far = CROSS + way * ARM_WAY;
    let across = ARM * vec2(way.y.abs(), way.x.abs());
    Rect::from_points(&[(near - across).to_pos2(), (far + across).to_pos2()])
}

/// Outline of the body.
pub(crate) fn outline() -> Vec<Pos2> {
    let right = HALF.iter().map(|[x, y]| pos2(*x, *y));
    let left = HALF.iter().rev().map(|[x, y]| pos2(-x, *y));
    // The points on the middle line are in both halves.
    let mut corners: Vec<Pos2> = right.chain(left).collect();
    corners.dedup();
    corners.pop();
    for _ in 0..ROUNDED {
        let next = corners.iter().cycle().skip(1);
        let cut = corners.iter().zip(next);
        let cut = cut.flat_map(|(one, other)| [one.lerp(*other, 0.25), one.lerp(*other, 0.75)]);
        corners = cut.collect();
    }
    corners
}
