//! The hand as a picture: its fingers bent as they are, fingertips with heat, force, shear and proximity. Turned by dragging.

use crate::app::state::Freshness;
use crate::hand::skeleton::{self, Bones, Point};
use crate::hand::{Finger, PerDof, PerFinger};
use crate::ui::controls;
use crate::ui::fingertip::{self, Tip};
use crate::ui::look::{Look, Pane};
use crate::ui::text::panels;
use crate::ui::{format, theme};
use egui::{Color32, Id, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};

/// Millimetres of the picture's height and width, and what stands in its middle.
const HEIGHT_MM: f32 = 192.0;
const WIDTH_MM: f32 = 172.0;
const MIDDLE: (f32, f32) = (20.0, 78.0);
/// Thickness of a finger.
const FINGER_MM: f32 = 16.0;
/// Rounding of the palm.
const PALM_MM: f32 = 12.0;
/// Radians of turning for a point of dragging.
const TURN: f32 = 0.01;
/// How far the picture can be turned to each side, and tipped.
const YAW_MAX: f32 = 1.4;
const PITCH_MAX: f32 = 0.9;
/// A target nearer than this to the actual angle is not drawn beside it.
const TARGET_GAP: i16 = 20;
/// Force from which a fingertip's number is written beside it, in newtons.
const CONTACT_N: f32 = 0.1;
/// Height from which numbers find room.
const ROOM_FOR_NUMBERS: f32 = 260.0;

/// From where the hand is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HandView {
    yaw: f32,
    pitch: f32,
}

impl Default for HandView {
    fn default() -> Self {
        // From a little beside and above, so that bent fingers are seen to be bent.
        Self {
            yaw: 0.5,
            pitch: 0.3,
        }
    }
}

/// One bone on its way to the screen.
struct Limb {
    finger: Finger,
    from: Pos2,
    to: Pos2,
    depth: f32,
    /// 1 if it lies in the picture's plane, 0 if it points at who looks.
    flat: f32,
    is_tip: bool,
}

impl HandView {
    /// Draws the hand and returns the finger that was clicked.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
        id: Id,
    ) -> Option<Finger> {
        let look = pane.look;
        let response = ui.interact(rect, id, Sense::click_and_drag());
        response.widget_info(|| {
            WidgetInfo::labeled(egui::Role::Image, true, look.say(panels::HAND_PICTURE))
        });
        if response.dragged() {
            let by = response.drag_delta() * TURN;
            self.yaw = (self.yaw + by.x).clamp(-YAW_MAX, YAW_MAX);
            self.pitch = (self.pitch + by.y).clamp(-PITCH_MAX, PITCH_MAX);
        }
        if response.double_clicked() {
            *self = Self::default();
        }
        let scene = Scene::new(self, rect);
        let pose = skeleton::joints(&actual(pane));
        scene.paint(ui, pane, &pose, tips);
        let clicked = response
            .clicked()
            .then(|| response.interact_pointer_pos())
            .flatten();
        response.on_hover_text(look.say(panels::HAND_PICTURE_TIP));
        clicked.and_then(|at| scene.finger_at(at, &pose))
    }
}

/// Draws a pose alone: for tiles and dry runs. `shares` of the way to open; an unknown joint gives no finger.
pub(crate) fn pose_ui(ui: &Ui, look: Look, rect: Rect, shares: &PerDof<Option<f32>>) {
    let scene = Scene::new(&HandView::default(), rect);
    scene.palm(ui.painter(), look, 1.0);
    let mut limbs: Vec<Limb> = Vec::with_capacity(11);
    for (finger, bones) in skeleton::joints(shares).iter() {
        match bones {
            Some(bones) => limbs.extend(scene.limbs(finger, bones)),
            None => scene.unknown(ui, look, finger),
        }
    }
    limbs.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    for limb in &limbs {
        scene.limb(ui.painter(), look, limb, None, 1.0);
    }
}

/// Shares of the way to open, where the angle is known and makes sense.
fn actual(pane: &Pane<'_>) -> PerDof<Option<f32>> {
    let angle = pane.state.sample.angle;
    PerDof::from_fn(|dof| {
        let raw = angle?.value[dof].documented()?;
        Some(f32::from(raw) / 1000.0)
    })
}

/// Where an armed hand is to go, for joints that are not there yet.
fn wanted(pane: &Pane<'_>) -> Option<PerDof<Option<f32>>> {
    let angle = pane.state.sample.angle?;
    if !pane.state.is_armed() {
        return None;
    }
    let mut far = false;
    let shares = PerDof::from_fn(|dof| {
        let target = pane.state.joints[dof].target?;
        far |= target.get().abs_diff(angle.value[dof].raw()) > TARGET_GAP.unsigned_abs();
        Some(f32::from(target.get()) / 1000.0)
    });
    far.then_some(shares)
}

/// Millimetres to points on the screen.
struct Scene {
    rect: Rect,
    center: Pos2,
    per_mm: f32,
    yaw: (f32, f32),
    pitch: (f32, f32),
    room: bool,
}

impl Scene {
    fn new(view: &HandView, rect: Rect) -> Self {
        Self {
            rect,
            center: rect.center(),
            per_mm: (rect.height() / HEIGHT_MM).min(rect.width() / WIDTH_MM),
            yaw: view.yaw.sin_cos(),
            pitch: view.pitch.sin_cos(),
            room: rect.height() >= ROOM_FOR_NUMBERS,
        }
    }

    /// The place on the screen, and how near it is to who looks.
    fn project(&self, point: Point) -> (Pos2, f32) {
        let (x, y) = (point.x - MIDDLE.0, point.y - MIDDLE.1);
        let (sin, cos) = self.yaw;
        let (side, depth) = (x * cos + point.z * sin, point.z * cos - x * sin);
        let (sin, cos) = self.pitch;
        let (up, depth) = (y * cos - depth * sin, depth * cos + y * sin);
        let at = self.center + vec2(side, -up) * self.per_mm;
        (at, depth)
    }

    fn paint(
        &self,
        ui: &Ui,
        pane: &Pane<'_>,
        pose: &PerFinger<Option<Bones>>,
        tips: &PerFinger<Option<Tip>>,
    ) {
        let look = pane.look;
        let angle = pane.state.sample.angle;
        let is_live = pane.freshness(angle.map(|angle| angle.asked)) == Freshness::Live;
        let fade = if is_live { 1.0 } else { 0.4 };
        let painter = ui.painter();
        self.palm(painter, look, fade);
        let mut limbs: Vec<Limb> = Vec::with_capacity(11);
        for (finger, bones) in pose.iter() {
            match bones {
                Some(bones) => limbs.extend(self.limbs(finger, bones)),
                None => self.unknown(ui, look, finger),
            }
        }
        limbs.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        for limb in &limbs {
            self.limb(painter, look, limb, tips[limb.finger].as_ref(), fade);
        }
        if let Some(target) = wanted(pane) {
            self.ghost(painter, look, &skeleton::joints(&target));
        }
        let mut taken = Vec::new();
        for limb in limbs.iter().filter(|limb| limb.is_tip) {
            if let Some(tip) = &tips[limb.finger] {
                self.force(ui, look, limb, tip, &mut taken);
            }
        }
    }

    fn palm(&self, painter: &Painter, look: Look, fade: f32) {
        let corners: Vec<Pos2> = skeleton::PALM
            .iter()
            .map(|corner| self.project(*corner).0)
            .collect();
        let width = PALM_MM * self.per_mm;
        for (grow, color) in [(2.0, look.palette.limb_edge), (0.0, look.palette.limb)] {
            let color = over(look, color, fade);
            painter.add(Shape::convex_polygon(corners.clone(), color, Stroke::NONE));
            for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                capsule(painter, *from, *to, width + grow, color);
            }
        }
    }

    fn limbs<'a>(&'a self, finger: Finger, bones: &'a Bones) -> impl Iterator<Item = Limb> + 'a {
        let last = bones.len().saturating_sub(2);
        bones
            .iter()
            .zip(bones.iter().skip(1))
            .enumerate()
            .map(move |(at, (from, to))| {
                let ((from, near), (to, far)) = (self.project(*from), self.project(*to));
                let length = (to - from).length().hypot((far - near) * self.per_mm);
                Limb {
                    finger,
                    from,
                    to,
                    depth: f32::midpoint(near, far),
                    flat: if length > 0.0 {
                        (to - from).length() / length
                    } else {
                        1.0
                    },
                    is_tip: at == last,
                }
            })
    }

    fn limb(&self, painter: &Painter, look: Look, limb: &Limb, tip: Option<&Tip>, fade: f32) {
        let palette = look.palette;
        let width = FINGER_MM * self.per_mm;
        // What points at who looks is lit, what lies flat is in half light.
        let lit = palette
            .limb
            .lerp_to_gamma(palette.limb_lit, 1.0 - limb.flat * 0.75);
        let line = palette.dof[limb.finger.bend()];
        if limb.is_tip {
            halo(painter, look, limb, tip, width, fade);
        }
        for (grow, color) in [
            (2.5, over(look, line, fade * 0.75)),
            (0.0, over(look, lit, fade)),
        ] {
            capsule(painter, limb.from, limb.to, width + grow, color);
        }
        painter.circle_filled(limb.from, width * 0.17, over(look, palette.limb_edge, fade));
        if let Some(heat) = tip.filter(|_| limb.is_tip).and_then(hottest) {
            let from = limb.from + (limb.to - limb.from) * 0.45;
            capsule(
                painter,
                from,
                limb.to,
                width * 0.72,
                over(look, palette.heat(heat), fade),
            );
        }
    }

    /// A finger whose angle is not known: where it begins, and no pose.
    fn unknown(&self, ui: &Ui, look: Look, finger: Finger) {
        // The knuckle is where the finger begins in any pose.
        let open = skeleton::joints(&PerDof::splat(Some(1.0)));
        let Some(knuckle) = open[finger].as_ref().and_then(|bones| bones.first()) else {
            return;
        };
        let (at, _) = self.project(*knuckle);
        let radius = FINGER_MM * self.per_mm / 2.0;
        ui.painter().circle(
            at,
            radius,
            look.palette.sunken,
            Stroke::new(1.0, look.palette.faint),
        );
        let place = Rect::from_center_size(at, Vec2::splat(radius * 2.0));
        controls::paint_text(
            ui,
            place,
            egui::Align2::CENTER_CENTER,
            format::UNKNOWN,
            theme::small(),
            look.palette.faint,
        );
    }

    /// Where the hand is told to go, as a thin line.
    fn ghost(&self, painter: &Painter, look: Look, pose: &PerFinger<Option<Bones>>) {
        for (finger, bones) in pose.iter() {
            let Some(bones) = bones else { continue };
            let points: Vec<Pos2> = bones.iter().map(|bone| self.project(*bone).0).collect();
            let color = look.palette.dof[finger.bend()];
            if let Some(end) = points.last() {
                painter.circle_stroke(
                    *end,
                    FINGER_MM * self.per_mm * 0.36,
                    Stroke::new(1.5, color),
                );
            }
            painter.extend(Shape::dashed_line(
                &points,
                Stroke::new(1.5, color),
                4.0,
                3.0,
            ));
        }
    }

    /// Normal force as a ring and a number, tangential force as an arrow.
    fn force(&self, ui: &Ui, look: Look, limb: &Limb, tip: &Tip, taken: &mut Vec<Rect>) {
        let along = (limb.to - limb.from).normalized();
        let width = FINGER_MM * self.per_mm;
        let middle = limb.to - along * width * 0.3;
        fingertip::forces_at(ui.painter(), look, middle, along, width, tip);
        let Some(normal) = tip
            .normal_n
            .filter(|normal| *normal >= CONTACT_N && self.room)
        else {
            return;
        };
        let text = format!("{} N", format::newtons(Some(normal)));
        let font = theme::number_small();
        let size = vec2(
            controls::text_width(ui, &text, font.clone()) + theme::GAP,
            16.0,
        );
        // Beside the tip, away from the middle of the hand, and below a number that stands there already.
        let side = if middle.x < self.center.x { -1.0 } else { 1.0 };
        let beside = middle + vec2(side * (width * 0.8 + size.x / 2.0), -width * 0.2);
        let mut place = Rect::from_center_size(beside, size);
        let shift = (self.rect.left() - place.left()).max(0.0)
            - (place.right() - self.rect.right()).max(0.0);
        place = place.translate(vec2(shift, 0.0));
        while let Some(above) = taken.iter().find(|other| other.intersects(place)) {
            place = place.translate(vec2(0.0, above.bottom() - place.top() + 1.0));
        }
        taken.push(place);
        let ground = look.palette.card.gamma_multiply(0.85);
        ui.painter().rect_filled(place, theme::STEP, ground);
        let color = if tip.stale {
            look.palette.faint
        } else {
            look.palette.dof[limb.finger.bend()]
        };
        controls::paint_text(ui, place, egui::Align2::CENTER_CENTER, &text, font, color);
    }

    /// The finger whose bones are nearest to a place, if it is on one.
    fn finger_at(&self, at: Pos2, pose: &PerFinger<Option<Bones>>) -> Option<Finger> {
        let reach = FINGER_MM * self.per_mm;
        pose.iter()
            .filter_map(|(finger, bones)| {
                let nearest = self
                    .limbs(finger, bones.as_ref()?)
                    .map(|limb| distance(at, limb.from, limb.to))
                    .fold(f32::INFINITY, f32::min);
                (nearest <= reach).then_some((finger, nearest))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(finger, _)| finger)
    }
}

fn halo(painter: &Painter, look: Look, limb: &Limb, tip: Option<&Tip>, width: f32, fade: f32) {
    let level = tip.map_or(0.0, Tip::nearness) * fade;
    if level <= 0.02 {
        return;
    }
    let from = limb.from + (limb.to - limb.from) * 0.5;
    for (grow, part) in [(1.9, 0.12), (1.5, 0.2)] {
        let color = look.palette.accent.gamma_multiply(part * level);
        capsule(painter, from, limb.to, width * grow, color);
    }
}

/// A line with round ends.
fn capsule(painter: &Painter, from: Pos2, to: Pos2, width: f32, color: Color32) {
    let radius = width / 2.0;
    let along = to - from;
    let turn = if along.length() > 0.01 {
        along.angle()
    } else {
        0.0
    };
    let half_circle = |center: Pos2, start: f32| {
        (0..=8u8).map(move |step| {
            let angle = start + std::f32::consts::PI * f32::from(step) / 8.0;
            center + Vec2::angled(angle) * radius
        })
    };
    let quarter = std::f32::consts::FRAC_PI_2;
    let points: Vec<Pos2> = half_circle(to, turn - quarter)
        .chain(half_circle(from, turn + quarter))
        .collect();
    painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
}

/// A colour that fades towards the card without letting what is behind shine through.
fn over(look: Look, color: Color32, part: f32) -> Color32 {
    look.palette.card.lerp_to_gamma(color, part)
}

fn hottest(tip: &Tip) -> Option<f32> {
    let known = tip.heat.iter().flatten().copied();
    known.reduce(f32::max)
}

fn distance(at: Pos2, from: Pos2, to: Pos2) -> f32 {
    let along = to - from;
    let length = along.length_sq();
    let part = if length > 0.0 {
        ((at - from).dot(along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    at.distance(from + along * part)
}
