//! The hand as a picture: its fingers bent as they are, fingertips as instruments. Turned by dragging; fingers are chosen.

use crate::app::state::Freshness;
use crate::app::trails::Trails;
use crate::hand::skeleton;
use crate::hand::{Finger, PerDof, PerFinger};
use crate::ui::controls::{self, Button};
use crate::ui::fingertip::Tip;
use crate::ui::hand_scene::{Limb, Scene, Turn};
use crate::ui::look::{Look, Pane};
use crate::ui::text::{panels, touch as text, words};
use crate::ui::{format, theme};
use egui::{Align2, Id, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

/// Radians of turning for a point of dragging.
const TURN_RAD: f32 = 0.01;
/// How far the picture can be turned to each side, and tipped.
const YAW_MAX_RAD: f32 = 1.4;
const PITCH_MAX_RAD: f32 = 0.9;
/// A target nearer than this to the actual angle is not drawn beside it.
const TARGET_GAP: i16 = 20;
/// Force from which a number is joined to its fingertip, in newtons.
const CONTACT_N: f32 = 0.1;

/// How the hand is looked at, and what its fingertips did just now.
#[derive(Debug, Clone, Default)]
pub(crate) struct HandView {
    turn: Turn,
    trails: Trails,
}

impl HandView {
    /// Draws the hand and returns the finger that was chosen.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
        (id, chosen): (Id, Finger),
    ) -> Option<Finger> {
        let look = pane.look;
        self.trails.follow(&pane.state.sample, pane.state.now);
        let mut picture = rect;
        let (width, height) = theme::HAND_NUMBERS_ROOM;
        let heads = (rect.width() >= width && rect.height() >= height)
            .then(|| controls::take_top(&mut picture, theme::HAND_HEAD));
        let response = ui.interact(picture, id, Sense::click_and_drag());
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(panels::HAND_PICTURE)));
        if response.dragged() {
            let by = response.drag_delta() * TURN_RAD;
            self.turn.yaw = (self.turn.yaw + by.x).clamp(-YAW_MAX_RAD, YAW_MAX_RAD);
            self.turn.pitch = (self.turn.pitch + by.y).clamp(-PITCH_MAX_RAD, PITCH_MAX_RAD);
        }
        if response.double_clicked() {
            self.turn = Turn::default();
        }
        let scene = Scene::new(self.turn, picture);
        let angles = actual(pane);
        let limbs = scene.limbs(&skeleton::joints(&angles));
        self.paint(ui, pane, &scene, &limbs, (&angles, tips));
        ghost_note(ui, look, picture, &angles);
        let named = heads.and_then(|heads| heads_ui(ui, heads, pane, &limbs, (id, chosen)));
        let finger = response.hover_pos().and_then(|at| finger_at(at, &limbs));
        let clicked = finger.filter(|_| response.clicked());
        response.on_hover_text(finger.map_or_else(
            || look.say(panels::HAND_PICTURE_TIP).to_owned(),
            |finger| said(pane, finger),
        ));
        named.or(clicked)
    }

    fn paint(
        &self,
        ui: &Ui,
        pane: &Pane<'_>,
        scene: &Scene,
        limbs: &[Limb],
        (angles, tips): (&PerDof<Option<f32>>, &PerFinger<Option<Tip>>),
    ) {
        let look = pane.look;
        let angle = pane.state.sample.angle;
        let is_live = pane.freshness(angle.map(|angle| angle.asked)) == Freshness::Live;
        let fade = if is_live { 1.0 } else { 0.4 };
        let painter = ui.painter();
        scene.palm(painter, look, fade);
        for finger in unknown(angles) {
            scene.unknown(painter, look, finger);
        }
        for limb in limbs {
            scene.limb(painter, look, limb, tips[limb.finger].as_ref(), fade);
        }
        if let Some(target) = wanted(pane) {
            scene.target(painter, look, &skeleton::joints(&target));
        }
        let trails = (&self.trails, pane.state.now);
        for limb in limbs.iter().filter(|limb| limb.is_tip) {
            let across = skeleton::across(angles, limb.finger);
            if let Some((tip, across)) = tips[limb.finger].as_ref().zip(across) {
                scene.forces(painter, look, limb, across, tip, trails);
            }
        }
    }
}

/// Draws a pose alone: for tiles and dry runs. `shares` of the way to open; an unknown joint gives an outline.
pub(crate) fn pose_ui(ui: &Ui, look: Look, rect: Rect, shares: &PerDof<Option<f32>>) {
    let scene = Scene::new(Turn::default(), rect);
    scene.palm(ui.painter(), look, 1.0);
    for finger in unknown(shares) {
        scene.unknown(ui.painter(), look, finger);
    }
    for limb in &scene.limbs(&skeleton::joints(shares)) {
        scene.limb(ui.painter(), look, limb, None, 1.0);
    }
}

/// Fingers of which an angle is not known.
fn unknown(angles: &PerDof<Option<f32>>) -> impl Iterator<Item = Finger> {
    let pose = skeleton::joints(angles);
    Finger::ALL
        .into_iter()
        .filter(move |finger| pose[*finger].is_none())
}

/// Says under the picture what a dashed outline stands for.
fn ghost_note(ui: &mut Ui, look: Look, picture: Rect, angles: &PerDof<Option<f32>>) {
    if unknown(angles).next().is_some() {
        let place = picture.with_min_y(picture.bottom() - theme::PAD);
        controls::Label::new(look.say(text::GHOST), look.palette.faint)
            .small()
            .center()
            .put(ui, place);
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

/// A finger with its force, as a sentence reads it.
fn said(pane: &Pane<'_>, finger: Finger) -> String {
    let look = pane.look;
    let block = pane.state.sample.tactile[finger].map(|block| block.value);
    format!(
        "{}: {} {} N, {} {} N",
        look.say(words::finger(finger)),
        look.say(panels::TIP_NORMAL),
        format::newtons(block.map(|block| block.normal_n)),
        look.say(panels::TIP_SHEAR),
        format::newtons(block.map(|block| block.tangential_n)),
    )
}

/// The fingers by name in one row over the picture, each with its normal force, joined to its fingertip in contact.
fn heads_ui(
    ui: &mut Ui,
    row: Rect,
    pane: &Pane<'_>,
    limbs: &[Limb],
    (id, chosen): (Id, Finger),
) -> Option<Finger> {
    let look = pane.look;
    let mut picked = None;
    let width = row.width() / 5.0;
    for (finger, at) in Finger::ALL.into_iter().zip(0u8..) {
        let left = row.left() + width * f32::from(at);
        let place = Rect::from_min_size(egui::pos2(left, row.top()), vec2(width, row.height()));
        let place = place.shrink2(vec2(1.0, 0.0));
        let name = format!("{}: {}", look.say(text::DRAWN), said(pane, finger));
        let button = Button::new("", look.say(panels::TIP_TIP))
            .named(&name)
            .choice(finger == chosen);
        if button.ground(ui, look, place, id.with(finger)).clicked() {
            picked = Some(finger);
        }
        let (upper, lower) = place.split_top_bottom_at_fraction(0.5);
        let block = pane.state.sample.tactile[finger];
        let freshness = pane.freshness(block.map(|block| block.asked));
        let color = look.value(freshness, look.palette.dof[finger.bend()]);
        let normal = block.map(|block| block.value.normal_n);
        for (place, words, font, color) in [
            (
                upper,
                look.say(words::finger(finger)).to_owned(),
                theme::small(),
                look.palette.muted,
            ),
            (
                lower,
                format!("{} N", format::newtons(normal)),
                theme::number(),
                color,
            ),
        ] {
            controls::paint_text(ui, place, Align2::CENTER_CENTER, &words, font, color);
        }
        let touches = normal.is_some_and(|normal| normal >= CONTACT_N);
        let limb = limbs
            .iter()
            .find(|limb| limb.is_tip && limb.finger == finger);
        if let Some(limb) = limb.filter(|_| touches) {
            let stroke = Stroke::new(1.0, color.gamma_multiply(0.4));
            ui.painter()
                .line_segment([place.center_bottom(), limb.to], stroke);
        }
    }
    picked
}

/// The finger whose bones are nearest to a place, if it is on one.
fn finger_at(at: Pos2, limbs: &[Limb]) -> Option<Finger> {
    limbs
        .iter()
        .map(|limb| (limb, distance(at, limb.from, limb.to)))
        .filter(|(limb, apart)| *apart <= limb.widths.0)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(limb, _)| limb.finger)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Dof;

    #[test]
    fn a_finger_of_which_any_angle_is_missing_is_an_outline() {
        let mut angles = PerDof::splat(Some(0.5));
        assert_eq!(unknown(&angles).count(), 0);
        angles[Dof::Ring] = None;
        angles[Dof::ThumbRotate] = None;
        let outlines: Vec<Finger> = unknown(&angles).collect();
        assert_eq!(outlines, [Finger::Ring, Finger::Thumb]);
    }

    #[test]
    fn the_finger_under_the_pointer_is_the_one_whose_tip_is_there() {
        let room = Rect::from_min_size(Pos2::ZERO, vec2(300.0, 300.0));
        let scene = Scene::new(Turn::default(), room);
        for share in [0.2, 1.0] {
            let limbs = scene.limbs(&skeleton::joints(&PerDof::splat(Some(share))));
            for limb in limbs.iter().filter(|limb| limb.is_tip) {
                assert_eq!(finger_at(limb.to, &limbs), Some(limb.finger), "{share}");
            }
            assert_eq!(finger_at(Pos2::ZERO, &limbs), None);
        }
    }
}
