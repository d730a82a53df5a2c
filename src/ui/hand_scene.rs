//! The hand in space on its way to the screen: projection, palm, bones, fingertips. Knows no pointer and no choice.

use crate::app::trails::Trails;
use crate::hand::Moment;
use crate::hand::skeleton::{self, Bones, Point};
use crate::hand::{Finger, PerDof, PerFinger};
use crate::ui::fingertip::{self, Plane, Tip};
use crate::ui::look::Look;
use crate::ui::theme;
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

/// The ball of the thumb: where it begins, and how thick it is there and at the thumb's first joint.
const BALL: Point = Point {
    x: 8.0,
    y: 16.0,
    z: 5.0,
};
const BALL_MM: (f32, f32) = (34.0, 25.0);
/// From where the hand is looked at, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    /// Around the hand's long axis: below 0 shows the thumb's side.
    pub(crate) yaw: f32,
    /// Up and down: below 0 looks from below.
    pub(crate) pitch: f32,
}

impl Default for Turn {
    fn default() -> Self {
        // From the thumb's side and a little below: bending is seen as bending, and no finger hides another's tip.
        Self {
            yaw: -0.65,
            pitch: -0.28,
        }
    }
}

/// One bone on its way to the screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limb {
    pub(crate) finger: Finger,
    pub(crate) from: Pos2,
    pub(crate) to: Pos2,
    /// Points across, at either end.
    pub(crate) widths: (f32, f32),
    depth: f32,
    /// Length on the screen of a bone that is one point long.
    flat: f32,
    pub(crate) is_tip: bool,
}

/// Millimetres to points on the screen.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) center: Pos2,
    pub(crate) per_mm: f32,
    middle: Vec2,
    yaw: (f32, f32),
    pitch: (f32, f32),
}

impl Scene {
    /// Fits all poses into a rectangle, so that nothing jumps while the hand moves.
    pub(crate) fn new(turn: Turn, rect: Rect) -> Self {
        let mut scene = Self {
            center: rect.center(),
            per_mm: 1.0,
            middle: Vec2::ZERO,
            yaw: turn.yaw.sin_cos(),
            pitch: turn.pitch.sin_cos(),
        };
        let mut bounds = Rect::NOTHING;
        for point in skeleton::REACH.iter() {
            let (at, _) = scene.turned(*point);
            bounds.extend_with(at.to_pos2());
        }
        let bounds = bounds.expand(theme::HAND_MARGIN_MM);
        scene.middle = bounds.center().to_vec2();
        scene.per_mm = (rect.width() / bounds.width()).min(rect.height() / bounds.height());
        scene
    }

    /// Millimetres right and up as seen, and how near.
    fn turned(&self, point: Point) -> (Vec2, f32) {
        let (sin, cos) = self.yaw;
        let (side, depth) = (point.x * cos + point.z * sin, point.z * cos - point.x * sin);
        let (sin, cos) = self.pitch;
        let (up, depth) = (point.y * cos - depth * sin, depth * cos + point.y * sin);
        (vec2(side, up), depth)
    }

    /// The place on the screen, and how near it is to who looks.
    fn project(&self, point: Point) -> (Pos2, f32) {
        let (at, depth) = self.turned(point);
        let from_middle = at - self.middle;
        let place = self.center + vec2(from_middle.x, -from_middle.y) * self.per_mm;
        (place, depth)
    }

    /// A way in space as a way on the screen.
    fn way(&self, way: Point) -> Vec2 {
        let (at, _) = self.turned(way);
        vec2(at.x, -at.y)
    }

    /// The bones of all known fingers, the farthest first.
    pub(crate) fn limbs(&self, pose: &PerFinger<Option<Bones>>) -> Vec<Limb> {
        let mut limbs = Vec::with_capacity(11);
        for (finger, bones) in pose.iter() {
            limbs.extend(bones.iter().flat_map(|bones| self.finger(finger, bones)));
        }
        limbs.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        limbs
    }

    fn finger<'a>(&'a self, finger: Finger, bones: &'a Bones) -> impl Iterator<Item = Limb> + 'a {
        let count = bones.len().saturating_sub(1).max(1);
        let more = if finger == Finger::Thumb {
            theme::THUMB_MORE
        } else {
            1.0
        };
        #[expect(clippy::cast_precision_loss, reason = "at most three bones")]
        let width = move |joint: usize| {
            let part = joint as f32 / count as f32;
            (theme::KNUCKLE_MM + (theme::FINGERTIP_MM - theme::KNUCKLE_MM) * part)
                * more
                * self.per_mm
        };
        let pairs = bones.iter().zip(bones.iter().skip(1)).enumerate();
        pairs.map(move |(at, (from, to))| {
            let ((from, near), (to, far)) = (self.project(*from), self.project(*to));
            let length = (to - from).length().hypot((far - near) * self.per_mm);
            Limb {
                finger,
                from,
                to,
                widths: (width(at), width(at + 1)),
                depth: f32::midpoint(near, far),
                flat: (to - from).length() / length.max(0.01),
                is_tip: at + 1 == count,
            }
        })
    }

    /// The palm as a slab, and the ball of the thumb on it.
    pub(crate) fn palm(&self, painter: &Painter, look: Look, fade: f32) {
        let face = |z: f32| skeleton::PALM.map(|corner| self.project(Point { z, ..corner }).0);
        let (back, front) = (face(-theme::PALM_HALF_MM), face(theme::PALM_HALF_MM));
        let palette = look.palette;
        let side = palette.limb.lerp_to_gamma(palette.card, 0.35);
        slab(
            painter,
            &back,
            theme::PALM_MM * self.per_mm + 2.0,
            over(look, palette.limb_edge, fade),
        );
        for (at, next) in neighbours(&back).zip(neighbours(&front)) {
            let points = vec![at.0, at.1, next.1, next.0];
            painter.add(Shape::convex_polygon(
                points,
                over(look, side, fade),
                Stroke::NONE,
            ));
        }
        slab(
            painter,
            &back,
            theme::PALM_MM * self.per_mm,
            over(look, side, fade),
        );
        slab(
            painter,
            &front,
            theme::PALM_MM * self.per_mm + 2.0,
            over(look, palette.limb_edge, fade),
        );
        let lit = palette.limb.lerp_to_gamma(palette.limb_lit, 0.18);
        slab(
            painter,
            &front,
            theme::PALM_MM * self.per_mm,
            over(look, lit, fade),
        );
        let open = skeleton::joints(&PerDof::splat(Some(1.0)));
        let Some(root) = open[Finger::Thumb].as_ref().and_then(|bones| bones.first()) else {
            return;
        };
        let (from, to) = (self.project(BALL).0, self.project(*root).0);
        let widths = (BALL_MM.0 * self.per_mm, BALL_MM.1 * self.per_mm);
        let ball = palette.limb.lerp_to_gamma(palette.limb_lit, 0.26);
        capsule(painter, from, to, widths, over(look, ball, fade));
    }

    /// One bone with its light, its joint, and at the tip the heat of its pads.
    pub(crate) fn limb(
        &self,
        painter: &Painter,
        look: Look,
        limb: &Limb,
        tip: Option<&Tip>,
        fade: f32,
    ) {
        let palette = look.palette;
        let tip = tip.filter(|_| limb.is_tip);
        if let Some(tip) = tip {
            halo(painter, look, limb, tip, fade);
        }
        // What is near is lit, what is far lies in the shade.
        let near = (limb.depth / theme::SHADE_MM).clamp(-1.0, 1.0);
        let ground = palette
            .limb
            .lerp_to_gamma(palette.limb_lit, 0.3 * (1.0 + near));
        let line = palette.dof[limb.finger.bend()];
        for (grow, color) in [
            (2.5, over(look, line, fade * 0.8)),
            (0.0, over(look, ground, fade)),
        ] {
            let widths = (limb.widths.0 + grow, limb.widths.1 + grow);
            capsule(painter, limb.from, limb.to, widths, color);
        }
        let light = Vec2::splat(-theme::LIGHT_ASIDE);
        let lit = ground.lerp_to_gamma(palette.limb_lit, 0.7);
        capsule(
            painter,
            limb.from + light * limb.widths.0,
            limb.to + light * limb.widths.1,
            (limb.widths.0 * 0.4, limb.widths.1 * 0.4),
            over(look, lit, fade),
        );
        let joint = over(look, palette.limb_edge, fade);
        painter.circle_filled(limb.from, limb.widths.0 * 0.14, joint);
        if let Some(tip) = tip {
            pads(painter, look, limb, tip, fade);
        }
    }

    /// The outline of a finger whose angle is not known, as it would be open.
    pub(crate) fn unknown(&self, painter: &Painter, look: Look, finger: Finger) {
        let open = skeleton::joints(&PerDof::splat(Some(1.0)));
        let Some(bones) = &open[finger] else { return };
        let stroke = Stroke::new(theme::THIN, look.palette.faint);
        for limb in self.finger(finger, bones) {
            let mut outline = around(limb.from, limb.to, limb.widths);
            outline.extend(outline.first().copied());
            painter.extend(Shape::dashed_line(&outline, stroke, 3.0, 3.0));
        }
    }

    /// Where the hand is told to go, as a thin line.
    pub(crate) fn target(&self, painter: &Painter, look: Look, pose: &PerFinger<Option<Bones>>) {
        for (finger, bones) in pose.iter() {
            let Some(bones) = bones else { continue };
            let points: Vec<Pos2> = bones.iter().map(|bone| self.project(*bone).0).collect();
            let stroke = Stroke::new(theme::MEANT, look.palette.dof[finger.bend()]);
            if let Some(end) = points.last() {
                painter.circle_stroke(*end, theme::FINGERTIP_MM * self.per_mm * 0.4, stroke);
            }
            painter.extend(Shape::dashed_line(&points, stroke, 4.0, 3.0));
        }
    }

    /// The forces of a fingertip in its own plane, and where they pointed just now.
    pub(crate) fn forces(
        &self,
        painter: &Painter,
        look: Look,
        limb: &Limb,
        across: Point,
        tip: &Tip,
        (trails, now): (&Trails, Moment),
    ) {
        let along = (limb.to - limb.from).normalized();
        let middle = limb.from + (limb.to - limb.from) * 0.72;
        let plane = Plane::of_width(middle, along * limb.flat, self.way(across), limb.widths.1);
        let color = look.palette.arrow;
        for (from, to, fresh) in trails.steps(limb.finger, now) {
            let stroke = Stroke::new(1.0 + fresh, color.gamma_multiply(0.55 * fresh));
            painter.line_segment([plane.end(from), plane.end(to)], stroke);
        }
        fingertip::forces(painter, look, &plane, tip);
    }
}

fn neighbours(points: &[Pos2]) -> impl Iterator<Item = (Pos2, Pos2)> {
    points
        .iter()
        .copied()
        .zip(points.iter().copied().cycle().skip(1))
}

/// A convex plate with round edges.
fn slab(painter: &Painter, corners: &[Pos2], width: f32, color: Color32) {
    painter.add(Shape::convex_polygon(corners.to_vec(), color, Stroke::NONE));
    for (from, to) in neighbours(corners) {
        capsule(painter, from, to, (width, width), color);
    }
}

fn halo(painter: &Painter, look: Look, limb: &Limb, tip: &Tip, fade: f32) {
    let level = tip.nearness() * fade;
    if level <= 0.02 {
        return;
    }
    let from = limb.from + (limb.to - limb.from) * 0.5;
    for (grow, part) in [(2.1, 0.12), (1.6, 0.2)] {
        let color = look.palette.accent.gamma_multiply(part * level);
        let widths = (limb.widths.1 * grow, limb.widths.1 * grow);
        capsule(painter, from, limb.to, widths, color);
    }
}

/// The heat of the pads in three bands from the base to the tip: there is no room for each.
fn pads(painter: &Painter, look: Look, limb: &Limb, tip: &Tip, fade: f32) {
    let [one, two, three, four, five, six, seven, _] = tip.heat;
    let hottest = |pads: &[Option<f32>]| pads.iter().flatten().copied().reduce(f32::max);
    let along = limb.to - limb.from;
    for (from, to, heat) in [
        (0.40, 0.48, hottest(&[five, six])),
        (0.62, 0.82, hottest(&[one, two, three, four])),
        (0.98, 1.02, seven),
    ] {
        let Some(heat) = heat else { continue };
        // Rest keeps the colour of the finger: only what is touched stands out from two metres away.
        let hot = look
            .palette
            .limb
            .lerp_to_gamma(look.palette.heat(heat), (0.4 + heat * 3.0).min(1.0));
        let color = over(look, hot, fade);
        let width = limb.widths.1 * 0.74;
        let (from, to) = (limb.from + along * from, limb.from + along * to);
        capsule(painter, from, to, (width, width), color);
    }
}

/// A line with round ends that may be thicker at one of them.
fn capsule(painter: &Painter, from: Pos2, to: Pos2, widths: (f32, f32), color: Color32) {
    let points = around(from, to, widths);
    painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
}

/// The outline of such a line.
fn around(from: Pos2, to: Pos2, widths: (f32, f32)) -> Vec<Pos2> {
    let along = to - from;
    let turn = if along.length() > 0.01 {
        along.angle()
    } else {
        0.0
    };
    let half_circle = |center: Pos2, start: f32, radius: f32| {
        (0..=8u8).map(move |step| {
            let angle = start + std::f32::consts::PI * f32::from(step) / 8.0;
            center + Vec2::angled(angle) * radius
        })
    };
    let quarter = std::f32::consts::FRAC_PI_2;
    half_circle(to, turn - quarter, widths.1 / 2.0)
        .chain(half_circle(from, turn + quarter, widths.0 / 2.0))
        .collect()
}

/// A colour that fades towards the card without letting what is behind shine through.
fn over(look: Look, color: Color32, part: f32) -> Color32 {
    look.palette.card.lerp_to_gamma(color, part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tips(scene: &Scene, share: f32) -> Vec<Limb> {
        let pose = skeleton::joints(&PerDof::splat(Some(share)));
        let limbs = scene.limbs(&pose).into_iter();
        limbs.filter(|limb| limb.is_tip).collect()
    }

    fn room() -> Rect {
        Rect::from_min_size(Pos2::ZERO, vec2(300.0, 300.0))
    }

    #[test]
    fn every_pose_stays_in_its_room_from_every_side() {
        for (yaw, pitch) in [(-0.65, -0.28), (1.4, 0.9), (-1.4, -0.9), (0.0, 0.0)] {
            let scene = Scene::new(Turn { yaw, pitch }, room());
            for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
                for tip in tips(&scene, share) {
                    let radius = tip.widths.1 / 2.0;
                    assert!(
                        room().shrink(radius).contains(tip.to),
                        "{share}: {}",
                        tip.to
                    );
                }
            }
        }
    }

    #[test]
    fn no_pose_changes_the_scale() {
        let scene = Scene::new(Turn::default(), room());
        let known = Scene::new(Turn::default(), room());
        let widths = |share| {
            tips(&scene, share)
                .iter()
                .map(|tip| tip.widths.1)
                .sum::<f32>()
        };
        assert!((widths(0.0) - widths(1.0)).abs() < 1e-3);
        assert_eq!((scene.per_mm, scene.middle), (known.per_mm, known.middle));
    }

    #[test]
    fn no_fingertip_hides_another_when_half_closed_or_in_a_fist() {
        let scene = Scene::new(Turn::default(), room());
        for share in [0.0, 0.35, 0.5, 1.0] {
            let tips = tips(&scene, share);
            for (at, one) in tips.iter().enumerate() {
                for other in tips.iter().skip(at + 1) {
                    let apart = one.to.distance(other.to);
                    assert!(
                        apart > one.widths.1 * 0.5,
                        "{share}: {:?} on {:?}",
                        one.finger,
                        other.finger
                    );
                }
            }
        }
    }
}
