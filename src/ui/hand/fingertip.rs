//! Picture of one fingertip: skin, seven pads and the eighth channel as heat, force circle, shear arrow, proximity halo.

use crate::ui::kit::Look;
use crate::ui::theme;
use egui::{Color32, CornerRadius, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, vec2};

/// Half the width of the sensing area with the skin around it, in millimetres (protocol §5.2).
const HALF_WIDTH_MM: f32 = 8.0;
/// Upper end of the skin (the tip), in millimetres.
const TIP_MM: f32 = 13.4;
/// Lower end of the skin, in millimetres.
const BASE_MM: f32 = -12.6;
/// Margin around the skin for the halo.
const MARGIN_MM: f32 = 1.0;
/// Skin beside the sensing area, and at the tip.
const EDGE_MM: f32 = 0.6;
const TIP_EDGE_MM: f32 = 0.4;
/// Length of the shortest arrow, as a share of the longest.
const LEAST_SHEAR_PART: f32 = 0.12;
/// Normal force that fills the finger's width (manual 1.2: 20 N grip).
const FULL_NORMAL_N: f32 = 20.0;
/// Tolerance beyond the documented range before a reading counts as implausible, in newtons.
const SLACK_N: f32 = 0.5;
/// Tangential force of the longest arrow.
const FULL_SHEAR_N: f32 = 5.0;
/// Length of the longest arrow in millimetres.
const LONGEST_MM: f32 = 9.0;
/// Proximity at full halo strength. The scale ends near 16 million; contact begins far below.
const FULL_PROXIMITY_COUNTS: f32 = 2_000_000.0;

/// Height of a fingertip with its halo, in widths.
pub(crate) const HEIGHT_TO_WIDTH: f32 =
    (TIP_MM - BASE_MM + 2.0 * MARGIN_MM) / (2.0 * (HALF_WIDTH_MM + MARGIN_MM));

/// Values of one fingertip to draw; `None` values are not drawn.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tip {
    /// Heat of the eight channels, 0..=1.
    pub(crate) heat: [Option<f32>; 8],
    /// Normal force in newtons.
    pub(crate) normal_n: Option<f32>,
    /// Tangential force in newtons and its direction in degrees, 0 towards the tip, clockwise.
    pub(crate) shear: Option<(f32, f32)>,
    /// Proximity counts.
    pub(crate) proximity: Option<f32>,
    /// Draws pale: the values are old.
    pub(crate) stale: bool,
    /// Plausibility of the forces.
    pub(crate) sense: Sense,
}

/// Plausibility of a fingertip's forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Sense {
    /// Within the manual's range.
    #[default]
    Fine,
    /// A force that is not finite.
    NoNumber,
    /// A force outside the sensor's range.
    Beyond,
}

impl Sense {
    /// Grades normal and tangential force, in newtons, as received.
    pub(crate) fn of(normal: f32, tangential: f32) -> Self {
        let range = -SLACK_N..=FULL_NORMAL_N + SLACK_N;
        if !normal.is_finite() || !tangential.is_finite() {
            Self::NoNumber
        } else if range.contains(&normal) && range.contains(&tangential) {
            Self::Fine
        } else {
            Self::Beyond
        }
    }
}

impl Tip {
    /// Strength of the proximity halo, 0..=1.
    pub(crate) fn nearness(&self) -> f32 {
        let counts = self.proximity.unwrap_or(0.0);
        (counts / FULL_PROXIMITY_COUNTS).clamp(0.0, 1.0)
    }

    /// Opacity of its colours.
    fn fade(&self) -> f32 {
        if self.stale { 0.35 } else { 1.0 }
    }
}

/// Maps millimetres of the sensor to screen points.
struct Scale {
    center: Pos2,
    per_mm: f32,
}

impl Scale {
    fn fit(rect: Rect) -> Self {
        let width = HALF_WIDTH_MM + MARGIN_MM;
        let height = TIP_MM - BASE_MM + 2.0 * MARGIN_MM;
        let per_mm = (rect.width() / (2.0 * width)).min(rect.height() / height);
        let lift = (TIP_MM + BASE_MM) / 2.0 * per_mm;
        Self {
            center: rect.center() + vec2(0.0, lift),
            per_mm,
        }
    }

    fn at(&self, x: f32, y: f32) -> Pos2 {
        self.center + vec2(x * self.per_mm, -y * self.per_mm)
    }

    /// Middle of the pads.
    fn middle(&self) -> Pos2 {
        self.at(0.0, 0.6)
    }

    /// End of the arrow of a force in newtons and a direction in degrees, 0 towards the tip, clockwise.
    fn end(&self, shear: f32, direction: f32) -> Pos2 {
        let length = (shear / FULL_SHEAR_N).clamp(LEAST_SHEAR_PART, 1.0) * LONGEST_MM * self.per_mm;
        self.middle() + Vec2::angled((direction - 90.0).to_radians()) * length
    }

    fn shape(&self, points: &[(f32, f32)]) -> Vec<Pos2> {
        points.iter().map(|(x, y)| self.at(*x, *y)).collect()
    }
}

/// Outlines of pads 1 to 7 as polygons in millimetres. Centres as in protocol §5.2; the outlines fill the area between them.
const PADS: [&[(f32, f32)]; 7] = [
    &[(-5.6, 6.2), (-0.7, 0.6), (-5.6, -5.2)],
    &[(-5.0, 6.7), (5.0, 6.7), (0.0, 1.0)],
    &[(5.6, 6.2), (5.6, -5.2), (0.7, 0.6)],
    &[(-5.0, -5.7), (0.0, 0.1), (5.0, -5.7)],
    &[
        (-5.6, -6.6),
        (-0.4, -6.6),
        (-0.4, -11.2),
        (-4.4, -11.2),
        (-5.6, -10.0),
    ],
    &[
        (0.4, -6.6),
        (5.6, -6.6),
        (5.6, -10.0),
        (4.4, -11.2),
        (0.4, -11.2),
    ],
    &[
        (-5.4, 7.6),
        (5.4, 7.6),
        (4.9, 9.4),
        (3.6, 10.9),
        (1.9, 11.7),
        (0.0, 12.0),
        (-1.9, 11.7),
        (-3.6, 10.9),
        (-4.9, 9.4),
    ],
];

/// Draws a fingertip into a rectangle, tip up.
pub(crate) fn paint(painter: &Painter, look: Look, rect: Rect, tip: &Tip) {
    let scale = Scale::fit(rect);
    halo(painter, look, &scale, tip);
    skin(painter, look, &scale);
    pads(painter, look, &scale, tip);
    forces(painter, look, &scale, tip);
}

fn outline(scale: &Scale, grow_mm: f32) -> (Rect, CornerRadius) {
    let half = HALF_WIDTH_MM - EDGE_MM + grow_mm;
    let tip = scale.at(-half, TIP_MM - TIP_EDGE_MM + grow_mm);
    let rect = Rect::from_two_pos(tip, scale.at(half, BASE_MM - grow_mm));
    let round = |mm: f32| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to a byte"
        )]
        let points = (mm * scale.per_mm).clamp(0.0, f32::from(u8::MAX)) as u8;
        points
    };
    let (tip, base) = (round(half * 0.94), round(2.0 + grow_mm));
    (
        rect,
        CornerRadius {
            nw: tip,
            ne: tip,
            sw: base,
            se: base,
        },
    )
}

fn halo(painter: &Painter, look: Look, scale: &Scale, tip: &Tip) {
    let level = tip.nearness() * tip.fade();
    for (grow, part) in [(1.4, 0.10), (0.9, 0.16), (0.4, 0.26)] {
        let (rect, round) = outline(scale, grow);
        let color = look.palette.accent.gamma_multiply(part * level);
        painter.rect_filled(rect, round, color);
    }
}

fn skin(painter: &Painter, look: Look, scale: &Scale) {
    let (rect, round) = outline(scale, 0.0);
    let edge = Stroke::new(1.0, look.palette.edge);
    painter.rect(rect, round, look.palette.control, edge, StrokeKind::Inside);
}

fn pads(painter: &Painter, look: Look, scale: &Scale, tip: &Tip) {
    let (palette, fade) = (look.palette, tip.fade());
    let color = |heat: Option<f32>| {
        heat.map_or(Color32::TRANSPARENT, |heat| {
            palette.heat(heat).gamma_multiply(fade)
        })
    };
    let (channels, last) = tip.heat.split_at(7);
    for (pad, heat) in PADS.iter().zip(channels) {
        let stroke = Stroke::new(1.0, palette.edge);
        let pad = scale.shape(pad);
        painter.add(Shape::convex_polygon(pad.clone(), color(*heat), stroke));
        if heat.is_none() && tip.heat.iter().any(Option::is_some) {
            crossed(painter, &pad, palette.warn.gamma_multiply(fade));
        }
    }
    // The eighth channel belongs to no pad: it is a bar beside them.
    let bar = Rect::from_two_pos(scale.at(6.0, 4.6), scale.at(6.8, -4.6));
    let fill = color(last.first().copied().flatten());
    let edge = Stroke::new(1.0, palette.edge);
    painter.rect(bar, 1.0, fill, edge, StrokeKind::Inside);
}

/// Draws a cross over a pad whose channel has no value.
fn crossed(painter: &Painter, pad: &[Pos2], color: Color32) {
    let box_of = Rect::from_points(pad);
    let (center, arm) = (box_of.center(), box_of.size().min_elem() * 0.22);
    let stroke = Stroke::new(theme::FOCUS_LINE, color);
    for way in [vec2(arm, arm), vec2(arm, -arm)] {
        painter.line_segment([center - way, center + way], stroke);
    }
}

/// Draws the normal force as a circle and the tangential force as an arrow.
fn forces(painter: &Painter, look: Look, scale: &Scale, tip: &Tip) {
    let fade = tip.fade();
    let arrow = match tip.sense {
        Sense::Fine => look.palette.text.gamma_multiply(fade),
        Sense::NoNumber | Sense::Beyond => look.palette.warn.gamma_multiply(fade),
    };
    let (middle, thin) = (scale.middle(), Stroke::new(theme::FOCUS_LINE, arrow));
    if tip.sense == Sense::NoNumber {
        let radius = (HALF_WIDTH_MM - 1.0) * 0.5 * scale.per_mm;
        painter.circle_stroke(middle, radius, thin);
    }
    if let Some(normal) = tip.normal_n.filter(|normal| *normal > 0.0) {
        // Area grows with force, so that twice the force looks twice as large.
        let part = (normal / FULL_NORMAL_N).clamp(0.0, 1.0).sqrt();
        let radius = part * (HALF_WIDTH_MM - 1.0) * scale.per_mm;
        painter.circle(middle, radius, arrow.gamma_multiply(0.14), thin);
    }
    if let Some((shear, direction)) = tip.shear.filter(|(shear, _)| *shear > 0.0) {
        let by = scale.end(shear, direction) - middle;
        painter.arrow(middle, by, Stroke::new(2.0, arrow));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_and_what_is_out_of_range_are_told_apart() {
        for (normal, tangential, sense) in [
            (0.0, 0.0, Sense::Fine),
            (-0.1, 0.2, Sense::Fine),
            (20.0, 5.0, Sense::Fine),
            (f32::NAN, 0.0, Sense::NoNumber),
            (3.0, f32::INFINITY, Sense::NoNumber),
            (25.0, 1.0, Sense::Beyond),
            (-3.0, 1.0, Sense::Beyond),
            (3.0, 1e20, Sense::Beyond),
        ] {
            assert_eq!(
                Sense::of(normal, tangential),
                sense,
                "{normal} {tangential}"
            );
        }
    }

    #[test]
    fn an_arrow_turns_clockwise_from_the_tip() {
        let scale = Scale::fit(Rect::from_min_size(Pos2::ZERO, vec2(18.0, 28.0)));
        let end = |direction| scale.end(5.0, direction) - scale.middle();
        assert!(end(0.0).y < -5.0);
        assert!(end(90.0).x > 5.0);
        assert!(end(180.0).y > 5.0);
    }
}
