//! The parts to draw, with their coats, and the light on them: one key light, a soft fill, the sky, and the losses in folds and
//! shadows.

use crate::figure::bars::{Bars, Near};
use crate::figure::camera::{Camera, EYE_MM};
use crate::figure::shape::rings::step;
use crate::figure::solid::{Skin, Solid};
use crate::figure::studio::{self, Material, Studio, linear};
use egui::Color32;
use glam::{Affine3, Vec3};
use handscope_core::hand::kinematics::{Segment, SegmentFrames};

/// Falloff of the key light to the right and downwards, per millimetre.
const FALL_PER_MM: f32 = 0.0016;

/// Opacity of glass at its rim.
const RIM_PART: f32 = 0.75;
/// Width of the rim around the contact of a finger with a held object, and of the edge at which the object ends there.
const CONTACT_MM: f32 = 3.5;

/// One solid to draw.
#[derive(Debug)]
pub struct PlacedSolid<'a> {
    pub solid: &'a Solid,
    /// Segment that it belongs to, for the pointer and the shadows; `None` if it is not part of the hand.
    pub segment: Option<Segment>,
    pub frame: Affine3,
    pub coat: Coat,
}

/// Surface treatment of a part.
#[derive(Debug, Clone, Copy, Default)]
pub struct Coat {
    /// Opacity when viewed head-on; 0 means opaque.
    pub glass: f32,
    /// Colour of a glow in it, and its share.
    pub glow: Option<(Color32, f32)>,
    /// Colour of the pad's heat map, and its share over the pad's own colour.
    pub heat: Option<(Color32, f32)>,
    /// Colour of plain surfaces.
    pub color: Option<Color32>,
    /// The fingers shine through where they touch it: it ends softly at them, with a bright rim around each contact.
    pub is_held: bool,
}

/// The light of one picture.
#[derive(Debug)]
pub struct Light {
    studio: &'static Studio,
    bars: Bars,
    /// For outdated values: everything fades towards this colour by this share.
    pub veil: Option<(Color32, f32)>,
}

/// The light on one part.
pub(crate) struct Shade<'a> {
    light: &'a Light,
    near: Near,
    coat: Coat,
}

impl Light {
    /// Sets up the light for a hand in this pose.
    pub fn new(studio: &'static Studio, camera: &Camera, pose: &SegmentFrames) -> Self {
        Self {
            studio,
            bars: Bars::new(camera, pose, studio.key),
            veil: None,
        }
    }

    /// Returns the light on a part; `frame` is the part's frame in eye coordinates.
    pub(crate) fn on(&self, part: &PlacedSolid<'_>, frame: &Affine3) -> Shade<'_> {
        let middle = frame.transform_point3(part.solid.middle);
        Shade {
            light: self,
            near: self.bars.near(part.segment, middle, part.solid.radius),
            coat: part.coat,
        }
    }
}

impl Shade<'_> {
    /// Colour of a corner, in eye coordinates.
    pub(crate) fn color(&self, skin: Skin, at: Vec3, normal: Vec3) -> Color32 {
        let eye = (Vec3::Z * EYE_MM - at).normalize();
        let (facing, studio) = (normal.dot(eye).max(0.0), self.light.studio);
        let material = self.material(skin);
        let (sky, key) = self.near.left(at, normal);
        // The lamp is close: surfaces near it are brighter.
        let key = key * (1.0 + (at.y - at.x) * FALL_PER_MM);
        let lit = (normal.dot(studio.key) * 0.87 + 0.13).max(0.0) * key * studio.key_power;
        let fill = normal.dot(studio.fill).max(0.0) * (0.5 + 0.5 * sky) * studio.fill_power;
        let ambient = studio.ground + (studio.sky - studio.ground) * (0.5 + 0.5 * normal.y);
        let light = lit + fill + ambient * sky;
        let spark = normal
            .dot((studio.key + eye).normalize())
            .max(0.0)
            .powi(material.sharp);
        let mirror = material.mirror * soft_boxes(normal * (2.0 * facing) - eye);
        let rim = (1.0 - facing).powi(3) * studio.rim * (0.7 + 0.3 * normal.y);
        let around = (mirror + rim) * (0.3 + 0.7 * sky);
        let plus = spark * material.shine * key + rim.max(0.0) * 0.25;
        let mut rgb = material.base * (light + around) + plus;
        let mut blend = |color: Color32, strength: f32, share: f32| {
            rgb = rgb.lerp(linear(color) * strength, share);
        };
        if let Some((color, share)) = self.coat.heat.filter(|_| skin == Skin::Pad) {
            // The colour encodes the value, so shading has little effect on it.
            blend(color, 0.55 + 0.45 * light, share);
        }
        if let Some((color, share)) = self.coat.glow {
            blend(color, 0.35 + 0.65 * light, share);
        }
        if let Some((color, share)) = self.light.veil {
            blend(color, 1.0, share);
        }
        let glass = self.coat.glass;
        let mut alpha = if glass > 0.0 {
            glass + (RIM_PART - glass) * (1.0 - facing).powi(2)
        } else {
            1.0
        };
        if self.coat.is_held {
            let apart = self.near.apart(at);
            let contact = (1.0 - apart.abs() / CONTACT_MM).max(0.0);
            let inside = (-apart / CONTACT_MM).clamp(0.0, 1.0);
            alpha = (alpha * (1.0 - inside)).max(RIM_PART * contact);
        }
        studio::lit(rgb, alpha)
    }

    fn material(&self, skin: Skin) -> Material {
        let studio = self.light.studio;
        let like = match skin {
            Skin::Metal => studio.metal,
            Skin::Plate => studio.plate,
            Skin::Hinge => studio.hinge,
            Skin::Rubber => studio.rubber,
            Skin::Pad | Skin::Plain => studio.pad,
        };
        let own = self.coat.color.filter(|_| skin == Skin::Plain);
        Material {
            base: own.map_or(like.base, linear),
            ..like
        }
    }
}

/// Reflections in polished metal: a wide soft box above, a narrow one at each side, a dark floor.
fn soft_boxes(way: Vec3) -> f32 {
    step(-0.1, 0.55, way.y) * 0.75 + step(0.55, 0.95, way.x) * 0.35 + step(0.5, 0.9, -way.x) * 0.25
}
