//! All colours of the window, dark and light, by purpose. No sizes.

use crate::app::settings::Theme;
use crate::draw::figure::studio::{DARK_SIGNS, DARK_STUDIO, LIGHT_SIGNS, LIGHT_STUDIO, Studio};
use crate::hand::{Fault, PerDof, Status};
use egui::{Color32, Rgba};

/// Background luminance at which white and black text have equal contrast.
const HALF_BRIGHT: f32 = 0.179;

/// Relative luminance as WCAG 2 defines it.
fn luminance(color: Color32) -> f32 {
    let color = Rgba::from(color);
    0.2126 * color.r() + 0.7152 * color.g() + 0.0722 * color.b()
}

/// All colours of one theme, by purpose.
#[derive(Debug)]
pub(crate) struct Palette {
    /// Behind everything.
    pub(crate) window: Color32,
    /// Cards and bars.
    pub(crate) card: Color32,
    /// Buttons at rest.
    pub(crate) control: Color32,
    /// Hovered buttons.
    pub(crate) control_hover: Color32,
    /// Fields, rails, plot backgrounds.
    pub(crate) sunken: Color32,
    /// Edges of cards and fields.
    pub(crate) edge: Color32,
    /// Grid lines of a plot.
    pub(crate) grid: Color32,
    pub(crate) text: Color32,
    /// Labels beside values.
    pub(crate) muted: Color32,
    /// Old values, disabled controls, hints.
    pub(crate) faint: Color32,
    /// The colour of selection and focus.
    pub(crate) accent: Color32,
    /// Text on [`Self::accent`].
    pub(crate) on_accent: Color32,
    /// Text on [`Self::stop`].
    pub(crate) on_strong: Color32,
    /// Everything is fine.
    pub(crate) ok: Color32,
    /// Needs attention.
    pub(crate) warn: Color32,
    /// Needs action.
    pub(crate) bad: Color32,
    /// The built-in hand only.
    pub(crate) simulated: Color32,
    /// Armed: setpoints pass.
    pub(crate) armed: Color32,
    /// Text on [`Self::armed`].
    pub(crate) on_armed: Color32,
    /// The stop button.
    pub(crate) stop: Color32,
    /// The hovered stop button.
    pub(crate) stop_hover: Color32,
    /// Edge of the stop button.
    pub(crate) stop_edge: Color32,
    /// Handle of a slider.
    pub(crate) handle: Color32,
    /// Dot in a handle.
    pub(crate) handle_dot: Color32,
    /// Lights and materials of the drawn hand.
    pub(crate) studio: &'static Studio,
    /// Lights and materials for small pictures of poses.
    pub(crate) signs: &'static Studio,
    /// The six joints; distinguishable with all common kinds of colour blindness.
    pub(crate) dof: PerDof<Color32>,
    /// The theme it belongs to.
    pub(crate) theme: Theme,
}

/// Light on dark.
static DARK: Palette = Palette {
    window: Color32::from_rgb(0x0E, 0x11, 0x15),
    card: Color32::from_rgb(0x16, 0x1A, 0x20),
    control: Color32::from_rgb(0x23, 0x2A, 0x33),
    control_hover: Color32::from_rgb(0x2E, 0x37, 0x42),
    sunken: Color32::from_rgb(0x0F, 0x13, 0x18),
    edge: Color32::from_rgb(0x29, 0x30, 0x3A),
    grid: Color32::from_rgb(0x21, 0x27, 0x30),
    text: Color32::from_rgb(0xE8, 0xEC, 0xF2),
    muted: Color32::from_rgb(0xA2, 0xAC, 0xBA),
    faint: Color32::from_rgb(0x8F, 0x9A, 0xAA),
    accent: Color32::from_rgb(0x4C, 0x9B, 0xFF),
    on_accent: Color32::from_rgb(0x07, 0x17, 0x2B),
    on_strong: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    ok: Color32::from_rgb(0x43, 0xC4, 0x82),
    warn: Color32::from_rgb(0xF2, 0xB5, 0x3A),
    bad: Color32::from_rgb(0xFF, 0x65, 0x69),
    simulated: Color32::from_rgb(0xB5, 0x8C, 0xFF),
    armed: Color32::from_rgb(0xF2, 0xB5, 0x3A),
    on_armed: Color32::from_rgb(0x24, 0x1A, 0x04),
    stop: Color32::from_rgb(0xD6, 0x2D, 0x3A),
    stop_hover: Color32::from_rgb(0xBE, 0x22, 0x30),
    stop_edge: Color32::from_rgb(0xFF, 0x7A, 0x80),
    handle: Color32::from_rgb(0xE8, 0xEC, 0xF2),
    handle_dot: Color32::from_rgb(0x16, 0x1A, 0x20),
    studio: &DARK_STUDIO,
    signs: &DARK_SIGNS,
    dof: PerDof::new([
        Color32::from_rgb(0x54, 0xB9, 0xFF),
        Color32::from_rgb(0xEB, 0xA1, 0x0C),
        Color32::from_rgb(0x2D, 0xBE, 0x8C),
        Color32::from_rgb(0xE7, 0xE3, 0x48),
        Color32::from_rgb(0xEA, 0x6C, 0x3F),
        Color32::from_rgb(0xC7, 0x81, 0xC3),
    ]),
    theme: Theme::Dark,
};

/// Dark on light.
static LIGHT: Palette = Palette {
    window: Color32::from_rgb(0xEC, 0xEF, 0xF3),
    card: Color32::from_rgb(0xFC, 0xFD, 0xFE),
    control: Color32::from_rgb(0xE6, 0xEA, 0xF0),
    control_hover: Color32::from_rgb(0xD9, 0xDF, 0xE7),
    sunken: Color32::from_rgb(0xF1, 0xF4, 0xF7),
    edge: Color32::from_rgb(0xD3, 0xDA, 0xE2),
    grid: Color32::from_rgb(0xE2, 0xE7, 0xED),
    text: Color32::from_rgb(0x16, 0x1C, 0x24),
    muted: Color32::from_rgb(0x3F, 0x4A, 0x58),
    faint: Color32::from_rgb(0x5E, 0x6A, 0x79),
    accent: Color32::from_rgb(0x15, 0x60, 0xBE),
    on_accent: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    on_strong: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    ok: Color32::from_rgb(0x0E, 0x6B, 0x3E),
    warn: Color32::from_rgb(0x85, 0x54, 0x00),
    bad: Color32::from_rgb(0xC8, 0x22, 0x2E),
    simulated: Color32::from_rgb(0x76, 0x42, 0xD0),
    armed: Color32::from_rgb(0xF0, 0xA8, 0x1E),
    on_armed: Color32::from_rgb(0x24, 0x1A, 0x04),
    stop: Color32::from_rgb(0xD0, 0x22, 0x30),
    stop_hover: Color32::from_rgb(0xB6, 0x18, 0x26),
    stop_edge: Color32::from_rgb(0x96, 0x10, 0x1C),
    handle: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    handle_dot: Color32::from_rgb(0x4E, 0x5A, 0x69),
    studio: &LIGHT_STUDIO,
    signs: &LIGHT_SIGNS,
    dof: PerDof::new([
        Color32::from_rgb(0x1A, 0x65, 0xC7),
        Color32::from_rgb(0x8F, 0x4B, 0x0F),
        Color32::from_rgb(0x00, 0x74, 0x60),
        Color32::from_rgb(0x31, 0x46, 0x23),
        Color32::from_rgb(0xCC, 0x13, 0x54),
        Color32::from_rgb(0x92, 0x3C, 0x94),
    ]),
    theme: Theme::Light,
};

impl Palette {
    /// The colours of a theme.
    pub(crate) fn of(theme: Theme) -> &'static Self {
        match theme {
            Theme::Dark => &DARK,
            Theme::Light => &LIGHT,
        }
    }

    /// Colour of a drive's state: its first fault, else its status.
    pub(crate) const fn drive(&self, fault: Option<Fault>, status: Option<Status>) -> Color32 {
        match (fault, status) {
            (Some(_), _) => self.bad,
            (None, Some(status)) if status.is_protective() => self.bad,
            (None, Some(Status::Releasing | Status::Grasping)) => self.accent,
            (None, Some(Status::ForceReached)) => self.warn,
            (None, Some(Status::PositionReached)) => self.ok,
            (None, _) => self.faint,
        }
    }

    /// Text colour for any background.
    pub(crate) fn ink_on(ground: Color32) -> Color32 {
        if luminance(ground) > HALF_BRIGHT {
            Color32::BLACK
        } else {
            Color32::WHITE
        }
    }

    /// A faint tint of a colour over a card.
    pub(crate) fn wash(&self, color: Color32) -> Color32 {
        color.gamma_multiply(if self.theme == Theme::Dark {
            0.16
        } else {
            0.12
        })
    }

    /// Colour of a scale from cool to warm, distinct from the joints' colours; `part` is clamped to 0..=1. Visible everywhere on a
    /// plot's background; the best value has [`Self::ok`], which is not on the scale.
    pub(crate) fn scale(&self, part: f64) -> Color32 {
        let part = part.clamp(0.0, 1.0);
        // Omits the ends that would be invisible on the background.
        let level = match self.theme {
            Theme::Dark => 0.42 + 0.58 * part,
            Theme::Light => 0.58 * part,
        };
        let color = colorous::PLASMA.eval_continuous(level);
        Color32::from_rgb(color.r, color.g, color.b)
    }

    /// Colour of the heat scale; `level` is clamped to 0..=1.
    pub(crate) fn heat(&self, level: f32) -> Color32 {
        let level = f64::from(level.clamp(0.0, 1.0));
        // Rest must look calm on both backgrounds: dark on the dark skin, pale on the light one.
        let color = if self.theme == Theme::Dark {
            colorous::INFERNO.eval_continuous(0.12 + 0.88 * level)
        } else {
            colorous::YELLOW_ORANGE_RED.eval_continuous(level)
        };
        Color32::from_rgb(color.r, color.g, color.b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contrast(one: Color32, other: Color32) -> f32 {
        let (one, other) = (luminance(one) + 0.05, luminance(other) + 0.05);
        (one / other).max(other / one)
    }

    /// Perceived colours for full colour vision, and without the cones for red or for green, in linear red, green and
    /// blue (Machado, Oliveira and Fernandes 2009, severity 1).
    const EYES: [(&str, f64, [[f64; 3]; 3]); 3] = [
        (
            "all cones",
            0.13,
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        ),
        (
            "no cones for red",
            0.075,
            [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
        ),
        (
            "no cones for green",
            0.075,
            [
                [0.367_322, 0.860_646, -0.227_968],
                [0.280_085, 0.672_501, 0.047_413],
                [-0.011_820, 0.042_940, 0.968_881],
            ],
        ),
    ];

    /// The best of a scale is also drawn thicker than the others.
    const BEST_APART: f64 = 0.05;

    fn product(rows: [[f64; 3]; 3], of: [f64; 3]) -> [f64; 3] {
        rows.map(|row| row.iter().zip(of).map(|(a, b)| a * b).sum())
    }

    /// Lightness and the two axes of OKLab, in which equal distances look about equal; a distance of 0.02 is just visible.
    fn lab(color: Color32, eye: [[f64; 3]; 3]) -> [f64; 3] {
        let color = Rgba::from(color);
        let linear = [color.r(), color.g(), color.b()].map(f64::from);
        let seen = product(eye, linear).map(|part| part.clamp(0.0, 1.0));
        let cones = product(
            [
                [0.412_221, 0.536_333, 0.051_446],
                [0.211_903, 0.680_700, 0.107_397],
                [0.088_302, 0.281_719, 0.629_979],
            ],
            seen,
        );
        product(
            [
                [0.210_454, 0.793_618, -0.004_072],
                [1.977_998, -2.428_592, 0.450_594],
                [0.025_904, 0.782_772, -0.808_676],
            ],
            cones.map(f64::cbrt),
        )
    }

    fn distance(one: Color32, other: Color32, eye: [[f64; 3]; 3]) -> f64 {
        let parts = lab(one, eye).into_iter().zip(lab(other, eye));
        parts.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn joints_are_told_apart_by_every_common_eye_in_both_themes() {
        for theme in [Theme::Dark, Theme::Light] {
            let colors = Palette::of(theme).dof;
            for (eye, least, matrix) in EYES {
                for (one, a) in colors.iter() {
                    for (other, b) in colors.iter().filter(|(other, _)| *other != one) {
                        let found = distance(*a, *b, matrix);
                        assert!(
                            found >= least,
                            "{theme:?}, {eye}: {one:?} and {other:?} are {found:.3} apart"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn scales_are_seen_on_the_ground_of_a_plot_and_the_best_is_never_the_darkest() {
        for theme in [Theme::Dark, Theme::Light] {
            let palette = Palette::of(theme);
            let steps = (0..=20).map(|step| palette.scale(f64::from(step) / 20.0));
            let steps: Vec<Color32> = steps.collect();
            for color in steps.iter().chain([&palette.ok]) {
                for ground in [palette.sunken, palette.card] {
                    let found = contrast(*color, ground);
                    assert!(
                        found >= 3.0,
                        "{theme:?} {color:?} on {ground:?}: {found:.2}"
                    );
                }
                let found = contrast(Palette::ink_on(*color), *color);
                assert!(found >= 4.5, "{theme:?} words on {color:?}: {found:.2}");
            }
            let darkest = steps.iter().map(|color| luminance(*color));
            let darkest = darkest.fold(f32::INFINITY, f32::min);
            assert!(luminance(palette.ok) > darkest, "{theme:?}");
            for (eye, _, matrix) in EYES {
                for color in &steps {
                    let found = distance(palette.ok, *color, matrix);
                    assert!(found >= BEST_APART, "{theme:?}, {eye}: best and {color:?}");
                }
            }
        }
    }

    #[test]
    fn every_text_has_a_contrast_of_four_and_a_half_on_what_it_stands_on() {
        for theme in [Theme::Dark, Theme::Light] {
            let palette = Palette::of(theme);
            let grounds = [
                palette.window,
                palette.card,
                palette.sunken,
                palette.control,
            ];
            let words = [
                ("text", palette.text),
                ("muted", palette.muted),
                ("faint", palette.faint),
                ("accent", palette.accent),
                ("ok", palette.ok),
                ("warn", palette.warn),
                ("bad", palette.bad),
            ];
            let joints = palette.dof.iter().map(|(_, color)| ("joint", *color));
            for (name, color) in words.into_iter().chain(joints) {
                for ground in grounds {
                    let found = contrast(color, ground);
                    assert!(
                        found >= 4.5,
                        "{theme:?} {name} {color:?} on {ground:?}: {found:.2}"
                    );
                }
            }
            for (text, ground) in [
                (palette.on_accent, palette.accent),
                (palette.on_strong, palette.stop),
                (palette.on_strong, palette.stop_hover),
                (palette.on_accent, palette.simulated),
                (palette.on_accent, palette.warn),
                (palette.on_armed, palette.armed),
            ] {
                let found = contrast(text, ground);
                assert!(found >= 4.5, "{theme:?} {text:?} on {ground:?}: {found:.2}");
            }
        }
    }
}
