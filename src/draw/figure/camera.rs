//! From where the hand is looked at, and where on the screen its places are then.

use crate::figure::shape;
use egui::{Pos2, Rect, vec2};
use glam::{Affine3, Mat3, Vec3};
use handscope_core::hand::kinematics::{Segment, SegmentFrames, Side, tip_pad};
use handscope_core::hand::{Dof, Finger, PerDof};
use std::sync::LazyLock;

/// Distance of the eye from the middle of the hand, and that middle.
pub(crate) const EYE_MM: f32 = 900.0;
const MIDDLE: Vec3 = Vec3::new(0.0, 15.0, 125.0);

/// From where the hand is looked at, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Around the hand's long axis: above 0 shows the side of a right hand's little finger.
    pub yaw: f32,
    /// Above 0 looks from above.
    pub pitch: f32,
    /// Above 0 turns the picture to the left.
    pub roll: f32,
}

impl Turn {
    /// From where the other hand looks the same.
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
}

/// From places in the hand to places on the screen.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    /// The hand as the eye sees it: x right, y up, z near.
    pub hand: Affine3,
    center: Pos2,
    /// Points of a millimetre in the middle of the hand.
    pub per_mm: f32,
    /// What the places of the reach fill on the screen.
    pub bounds: Rect,
}

impl Camera {
    /// Fits the places of `reach` into a rectangle.
    pub fn new(turn: Turn, rect: Rect, reach: impl Iterator<Item = Vec3>) -> Self {
        // The eye looks against y, with z up.
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

    /// Where on the screen a place of the hand is.
    pub fn place(&self, at: Vec3) -> Pos2 {
        self.project(self.hand.transform_point3(at))
    }

    /// What the eye sees at this depth on a place of the screen.
    pub fn seen_at(&self, place: Pos2, depth: f32) -> Vec3 {
        let by = (place - self.center) * ((EYE_MM - depth) / (self.per_mm * EYE_MM));
        Vec3::new(by.x, -by.y, depth)
    }

    /// Where on the screen a place is that the eye sees there.
    pub fn project(&self, seen: Vec3) -> Pos2 {
        let scale = self.per_mm * EYE_MM / (EYE_MM - seen.z);
        self.center + vec2(seen.x, -seen.y) * scale
    }
}

/// Steps from bent to open in which poses are tried, and room around the ends of the fingers.
const STEPS: u8 = 4;
const ROUND_MM: f32 = 10.0;

/// Where a right hand gets to in all poses: a picture that holds these never jumps while the hand moves.
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
