//! From where the hand is looked at, and where on the screen its places are then.

use egui::{Pos2, Rect, vec2};
use glam::{Affine3, Mat3, Vec3};

/// Distance of the eye from the middle of the hand, and that middle.
pub(crate) const EYE_MM: f32 = 900.0;
const MIDDLE: Vec3 = Vec3::new(0.0, 15.0, 125.0);

/// From where the hand is looked at, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    /// Around the hand's long axis: above 0 shows the side of a right hand's little finger.
    pub(crate) yaw: f32,
    /// Above 0 looks from above.
    pub(crate) pitch: f32,
}

/// From places in the hand to places on the screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    /// The hand as the eye sees it: x right, y up, z near.
    pub(crate) hand: Affine3,
    center: Pos2,
    per_mm: f32,
}

impl Camera {
    /// Fits the places of `reach` into a rectangle.
    pub(crate) fn new(turn: Turn, rect: Rect, reach: impl Iterator<Item = Vec3>) -> Self {
        // The eye looks against y, with z up.
        let upright = Mat3::from_cols(Vec3::NEG_X, Vec3::Z, Vec3::Y);
        let turned = Mat3::from_rotation_x(turn.pitch) * Mat3::from_rotation_y(turn.yaw) * upright;
        let hand = Affine3::from_mat3_translation(turned, -(turned * MIDDLE));
        let mut camera = Self {
            hand,
            center: Pos2::ZERO,
            per_mm: 1.0,
        };
        let mut bounds = Rect::NOTHING;
        for at in reach {
            bounds.extend_with(camera.project(hand.transform_point3(at)));
        }
        camera.per_mm = (rect.width() / bounds.width()).min(rect.height() / bounds.height());
        camera.center = rect.center() - bounds.center().to_vec2() * camera.per_mm;
        camera
    }

    /// Where on the screen a place is that the eye sees there.
    pub(crate) fn project(&self, seen: Vec3) -> Pos2 {
        let scale = self.per_mm * EYE_MM / (EYE_MM - seen.z);
        self.center + vec2(seen.x, -seen.y) * scale
    }
}
