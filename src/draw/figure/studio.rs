//! Materials and lighting of the drawn hand, for each theme.

use egui::Color32;
use glam::Vec3;

/// Response of a surface to light. Colours are linear.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Material {
    /// Base colour.
    pub(crate) base: Vec3,
    /// Strength of the key light's highlight, and its exponent.
    pub(crate) shine: f32,
    pub(crate) sharp: i32,
    /// Share of the surroundings that it reflects.
    pub(crate) mirror: f32,
}

/// Lamps and materials of one theme. Directions are in eye coordinates: x right, y up, z towards the eye.
#[derive(Debug)]
pub struct Studio {
    /// Direction to the key light, and its strength.
    pub(crate) key: Vec3,
    pub(crate) key_power: f32,
    /// Direction to the fill light, and its strength.
    pub(crate) fill: Vec3,
    pub(crate) fill_power: f32,
    /// Light from above and from below.
    pub(crate) sky: f32,
    pub(crate) ground: f32,
    /// Light on surfaces that face away from the eye: sets them off from a dark card, or darkens them on a light one.
    pub(crate) rim: f32,
    pub(crate) metal: Material,
    pub(crate) plate: Material,
    pub(crate) hinge: Material,
    pub(crate) rubber: Material,
    pub(crate) pad: Material,
}

const fn material([red, green, blue]: [u8; 3], shine: f32, sharp: i32, mirror: f32) -> Material {
    let base = linear(Color32::from_rgb(red, green, blue));
    Material {
        base,
        shine,
        sharp,
        mirror,
    }
}

/// From the left, above and in front of the hand; and from the right.
const KEY: Vec3 = Vec3::new(-0.466, 0.670, 0.577);
const FILL: Vec3 = Vec3::new(0.884, 0.0, 0.468);

const DARK: Studio = Studio {
    key: KEY,
    key_power: 0.82,
    fill: FILL,
    fill_power: 0.16,
    sky: 0.22,
    ground: 0.08,
    rim: 0.42,
    metal: material([0xC4, 0xC9, 0xD0], 0.20, 32, 0.40),
    plate: material([0xA8, 0xAE, 0xB7], 0.06, 16, 0.15),
    hinge: material([0x4A, 0x50, 0x59], 0.14, 20, 0.5),
    rubber: material([0x44, 0x49, 0x51], 0.10, 9, 0.5),
    pad: material([0x74, 0x7C, 0x88], 0.05, 10, 0.2),
};

const LIGHT: Studio = Studio {
    key: KEY,
    key_power: 0.82,
    fill: FILL,
    fill_power: 0.22,
    sky: 0.28,
    ground: 0.14,
    rim: -0.3,
    metal: material([0xC2, 0xC8, 0xCF], 0.20, 32, 0.40),
    plate: material([0xA6, 0xAC, 0xB6], 0.06, 16, 0.15),
    hinge: material([0x46, 0x4C, 0x55], 0.12, 20, 0.5),
    rubber: material([0x38, 0x3C, 0x43], 0.08, 9, 0.5),
    pad: material([0x66, 0x6D, 0x78], 0.05, 10, 0.2),
};

pub static DARK_STUDIO: Studio = DARK;
pub static LIGHT_STUDIO: Studio = LIGHT;

/// For small pictures: fingers as light as the palm, so that they are legible at the size of a button.
pub static DARK_SIGNS: Studio = Studio {
    rubber: DARK.metal,
    hinge: material([0x8C, 0x94, 0x9F], 0.14, 20, 0.3),
    pad: DARK.metal,
    ..DARK
};
pub static LIGHT_SIGNS: Studio = Studio {
    rubber: LIGHT.metal,
    hinge: material([0x86, 0x8E, 0x99], 0.12, 20, 0.3),
    pad: LIGHT.metal,
    ..LIGHT
};

/// Converts to linear light, with the screen's gamma approximated as 2.
pub(crate) const fn linear(color: Color32) -> Vec3 {
    const fn squared(part: u8) -> f32 {
        let part = part as f32 / 255.0;
        part * part
    }
    let [red, green, blue, _] = color.to_array();
    Vec3::new(squared(red), squared(green), squared(blue))
}

/// Converts linear light to a colour; clamped at white.
pub(crate) fn lit(light: Vec3, alpha: f32) -> Color32 {
    let [red, green, blue] = light.clamp(Vec3::ZERO, Vec3::ONE).map(f32::sqrt).to_array();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 255"
    )]
    let [red, green, blue, alpha] =
        [red * alpha, green * alpha, blue * alpha, alpha].map(|part| (part * 255.0 + 0.5) as u8);
    Color32::from_rgba_premultiplied(red, green, blue, alpha)
}
