//! The view of the hand, and the projection of its points to the screen.

use crate::figure::shape;
use egui::{Pos2, Rect, vec2};
use glam::{Affine3, Mat3, Vec3};
use handscope_core::hand::kinematics::{Segment, SegmentFrames, Side, tip_pad};
use handscope_core::hand::{Dof, Finger, PerDof};
use std::sync::LazyLock;

/// Distance of the eye from the centre of the hand, and that centre.
pub(crate) const EYE_MM: f32 = 900.0;
const MIDDLE: Vec3 = Vec3::new(0.0, 15.0, 125.0);

/// Direction from which the hand is viewed, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// About the hand's long axis: positive values show the side of a right hand's little finger.
    pub yaw: f32,
    /// Positive values look from above.
    pub pitch: f32,
    /// Positive values turn the picture to the left.
    pub roll: f32,
}

impl Turn {
    /// The view in which the hand of this side looks the same.
    pub fn of(self, side: Side) -> Self {
        match side {
            Side::Right => self,
            Side::Left => Self {
                yaw: -self.yaw,
                roll: -self.roll,
                ..self
            },
        }
    }

    /// The view at this share of the way to another one.
    pub fn towards(self, other: Self, share: f32) -> Self {
        let at = |from: f32, to: f32| from + (to - from) * share;
        Self {
            yaw: at(self.yaw, other.yaw),
            pitch: at(self.pitch, other.pitch),
            roll: at(self.roll, other.roll),
        }
    }
}

/// Projects points of the hand to the screen.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    /// Hand coordinates to eye coordinates: x right, y up, z towards the eye.
    pub hand: Affine3,
    center: Pos2,
    /// Screen points per millimetre at the centre of the hand.
    pub per_mm: f32,
    /// Screen rectangle that the projected reach fills.
    pub bounds: Rect,
}

impl Camera {
    /// Fits the points of `reach` into a rectangle.
    pub fn new(turn: Turn, rect: Rect, reach: impl Iterator<Item = Vec3>) -> Self {
        // The eye looks along -y, with z up.
        let upright = Mat3::from_cols(Vec3::NEG_X, Vec3::Z, Vec3::Y);
        let turned = Mat3::from_rotation_z(turn.roll)
            * Mat3::from_rotation_x(turn.pitch)
            * Mat3::from_rotation_y(turn.yaw)
            * upright;
        let hand = Affine3::from_mat3_translation(turned, -(turned * MIDDLE));
        let mut camera = Self {
            hand,
            center: Pos2::ZERO,
            per_mm: 1.0,
            bounds: rect,
        };
        let mut bounds = Rect::NOTHING;
        for at in reach {
            bounds.extend_with(camera.place(at));
        }
        camera.per_mm = (rect.width() / bounds.width()).min(rect.height() / bounds.height());
        camera.center = rect.center() - bounds.center().to_vec2() * camera.per_mm;
        camera.bounds = Rect::from_center_size(rect.center(), bounds.size() * camera.per_mm);
        camera
    }

    /// Projects a point of the hand to the screen.
    pub fn place(&self, at: Vec3) -> Pos2 {
        self.project(self.hand.transform_point3(at))
    }

    /// Point in eye coordinates at a screen position and depth.
    pub fn seen_at(&self, place: Pos2, depth: f32) -> Vec3 {
        let by = (place - self.center) * ((EYE_MM - depth) / (self.per_mm * EYE_MM));
        Vec3::new(by.x, -by.y, depth)
    }

    /// Projects a point in eye coordinates to the screen.
    pub fn project(&self, seen: Vec3) -> Pos2 {
        let scale = self.per_mm * EYE_MM / (EYE_MM - seen.z);
        self.center + vec2(seen.x, -seen.y) * scale
    }
}

/// Number of steps from bent to open in which poses are sampled, and margin around the fingertips.
const STEPS: u8 = 4;
const ROUND_MM: f32 = 10.0;

/// Points that a right hand reaches in all poses: a picture fitted to these does not jump while the hand moves.
pub static REACH: LazyLock<Vec<Vec3>> = LazyLock::new(|| {
    let palm = [
        [30.0, -24.0, -13.0],
        [30.0, 20.0, -13.0],
        [45.0, -21.0, 50.0],
        [45.0, -18.0, 110.0],
        [45.0, 14.0, 140.0],
        [36.0, 36.0, 54.0],
    ];
    let both = palm
        .iter()
        .flat_map(|[x, y, z]| [[*x, *y, *z], [-x, *y, *z]]);
    let mut reach: Vec<Vec3> = both.map(Vec3::from).collect();
    let shares = || (0..=STEPS).map(|step| f32::from(step) / f32::from(STEPS));
    for (bend, swing) in shares().flat_map(|bend| shares().map(move |swing| (bend, swing))) {
        let pose = PerDof::from_fn(|dof| if dof == Dof::ThumbRotate { swing } else { bend });
        let pose = SegmentFrames::of_shares(Side::Right, &pose);
        for finger in Finger::ALL {
            let [out, up] = shape::pad_ways(finger);
            let (pad, frame) = (tip_pad(finger) + up * 3.0, pose.frame(Segment::tip(finger)));
            let back = pad - out * 2.0 * ROUND_MM;
            let (middle, aside) = (pad - (out + up) * ROUND_MM, out.cross(up) * ROUND_MM);
            let places = [pad, back, -out * ROUND_MM, middle - aside, middle + aside];
            reach.extend(places.map(|at| frame.transform_point3(at)));
        }
        let joint = pose.frame(Segment::Thumb3);
        reach.extend([Vec3::Z, Vec3::NEG_Y].map(|way| joint.transform_point3(way * ROUND_MM)));
    }
    reach
});
