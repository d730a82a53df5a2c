//! Viewpoint of the hand, and dragging on it, which turns the picture or moves a finger. Redrawn only when something changed.

use crate::app::settings::Theme;
use crate::draw::figure::camera::{Camera, REACH, Turn};
use crate::draw::figure::light::Light;
use crate::draw::figure::render::{Model, Sketch};
use crate::draw::figure::shape;
use crate::hand::kinematics::{Segment, Side};
use crate::hand::{Dof, Finger, PerDof, PerFinger};
use crate::ui::hand::finger_drag::FingerDrag;
use crate::ui::hand::scene::HandPicture;
use crate::ui::theme::Palette;
use egui::{CursorIcon, Mesh, Pos2, Rect, Response, Shape, Ui, emath};
use glam::Vec3;
use std::cell::OnceCell;
use std::sync::Arc;

/// Default viewpoint: three quarters from the thumb's side and from above, where a grasp is recognised as one.
pub(crate) const TURN: Turn = Turn {
    yaw: -0.61,
    pitch: 0.26,
    roll: 0.0,
};
/// Viewpoint while a fingertip is open: the pads face the viewer, and from slightly below also those of bent fingers.
pub(crate) const FRONT: Turn = Turn {
    yaw: 0.0,
    pitch: -0.18,
    roll: 0.0,
};
/// Time from one of the two viewpoints to the other.
const EASE_S: f32 = 0.2;
/// Rotation per point of dragging, and maximum pitch, in radians.
const TURN_RAD: f32 = 0.01;
const PITCH_MAX_RAD: f32 = 1.2;
/// Blend of old values towards the card's colour.
const STALE_PART: f32 = 0.55;
/// Height of a picture below which fewer triangles suffice, in points.
const SMALL_POINTS: f32 = 110.0;
/// Lower end of such a picture, in millimetres of the hand.
pub(crate) const CUT_MM: f32 = 42.0;
/// Length over which the palm fades out there.
const FADE_MM: f32 = 34.0;

/// Viewpoint of a hand, and the last drawn picture.
#[derive(Debug, Clone, Default)]
pub(crate) struct HandView {
    /// Viewpoint set by the user; `None` = the default one.
    pub(crate) turn: Option<Turn>,
    /// Share of the way from the default viewpoint to the frontal one.
    front: f32,
    pub(crate) drawn: Option<(HandPicture, DrawSettings)>,
    /// Anchor points of the drawn picture, once they are asked for: pictures without labels need none.
    points: OnceCell<HandPoints>,
    drag: HandDrag,
    pub(super) sketch: Sketch,
    pub(super) mesh: Arc<Mesh>,
}

/// Effect of the current drag.
#[derive(Debug, Clone, Copy, Default)]
enum HandDrag {
    /// Turns the picture.
    #[default]
    Turns,
    /// Moves a finger.
    Moves(FingerDrag),
    /// None: its finger cannot be moved any longer.
    Over,
}

/// Viewpoint, position and appearance of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawSettings {
    pub(crate) turn: Turn,
    pub(crate) rect: Rect,
    pub(crate) theme: Theme,
    /// Points per pixel: the width of soft edges.
    pub(crate) feather: f32,
}

/// Depth below the pad of the point that stands for a fingertip.
const INSIDE_MM: f32 = 7.0;

/// Position and content of a picture, and the joints that a drag may move.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HandStage<'a> {
    pub(crate) rect: Rect,
    pub(crate) palette: &'a Palette,
    pub(crate) picture: &'a HandPicture,
    pub(crate) movable: PerDof<bool>,
}

/// The user's interaction with the picture.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HandUse {
    /// Joint under the pointer, or the dragged one.
    pub(crate) joint: Option<Dof>,
    /// Dragged joint with its position, as a share of the way to open.
    pub(crate) moved: Option<(Dof, f32)>,
}

/// Anchor points in the picture for the labels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HandPoints {
    /// Places on each finger, from its tip to its base; `None` where something else hides it.
    pub(crate) along: PerFinger<[Option<Pos2>; 5]>,
    /// Area that the hand covers over all poses.
    pub(crate) bounds: Rect,
    /// The thumb is on the right.
    pub(crate) is_forward: bool,
}

impl HandView {
    /// Draws the hand. A drag moves a movable joint, else it turns the picture; a double click resets the viewpoint.
    pub(crate) fn ui(&mut self, ui: &Ui, response: &Response, stage: &HandStage<'_>) -> HandUse {
        if response.drag_started() {
            let origin = ui.input(|input| input.pointer.press_origin());
            let grip = origin.and_then(|at| self.grip(at));
            let grip = grip.filter(|grip| stage.movable[grip.dof]);
            self.drag = grip.map_or(HandDrag::Turns, HandDrag::Moves);
        }
        let mut used = HandUse::default();
        if response.dragged() {
            used = self.dragged(response, stage);
        } else if let Some(at) = response.hover_pos() {
            let seen = self.sketch.segment_at(&self.mesh, at);
            used.joint = seen.and_then(|seen| seen.segment.dof());
        }
        if response.double_clicked() {
            self.turn = None;
        }
        let icon = match used {
            HandUse { moved: Some(_), .. } => Some(CursorIcon::Grabbing),
            HandUse { joint, .. } => {
                let movable = joint.is_some_and(|dof| stage.movable[dof]);
                movable.then_some(CursorIcon::Grab)
            }
        };
        if let Some(icon) = icon {
            ui.ctx().set_cursor_icon(icon);
        }
        let mut picture = HandPicture {
            lit: used.joint.or(stage.picture.lit),
            ..*stage.picture
        };
        if let Some((dof, share)) = used.moved {
            picture.target[dof] = Some(share);
        }
        self.paint(ui, stage.rect, stage.palette, &picture);
        used
    }

    /// Grabs the part drawn at a position; `None` if no joint moves it.
    fn grip(&self, at: Pos2) -> Option<FingerDrag> {
        let (picture, setting) = self.drawn.as_ref()?;
        let seen = self.sketch.segment_at(&self.mesh, at)?;
        FingerDrag::new(&setting.camera(picture.side), picture, seen, at)
    }

    fn dragged(&mut self, response: &Response, stage: &HandStage<'_>) -> HandUse {
        let (at, drawn) = (response.interact_pointer_pos(), self.drawn);
        match &mut self.drag {
            HandDrag::Turns => {
                let by = response.drag_delta() * TURN_RAD;
                let turn = self.turn(stage.picture.side);
                let pitch = (turn.pitch + by.y).clamp(-PITCH_MAX_RAD, PITCH_MAX_RAD);
                self.turn = Some(Turn {
                    yaw: turn.yaw - by.x,
                    pitch,
                    ..turn
                });
            }
            HandDrag::Moves(grip) if stage.movable[grip.dof] => {
                let camera = drawn.map(|(picture, setting)| setting.camera(picture.side));
                let moved = camera
                    .zip(at)
                    .map(|(camera, at)| (grip.dof, grip.follow(&camera, stage.picture, at)));
                let joint = Some(grip.dof);
                return HandUse { joint, moved };
            }
            drag => *drag = HandDrag::Over,
        }
        HandUse::default()
    }

    /// Draws the hand from its current viewpoint.
    pub(crate) fn paint(&mut self, ui: &Ui, rect: Rect, palette: &Palette, picture: &HandPicture) {
        let setting = DrawSettings {
            turn: self.turn(picture.side),
            rect,
            theme: palette.theme,
            feather: 1.0 / ui.pixels_per_point(),
        };
        if rect.is_positive() {
            self.update(picture, setting);
        }
        // A wide object may reach below the labels beside the hand.
        let sides = ui.max_rect().x_range();
        let clip = rect.with_min_x(sides.min).with_max_x(sides.max);
        ui.painter()
            .with_clip_rect(clip)
            .add(Shape::Mesh(Arc::clone(&self.mesh)));
    }

    /// Draws the picture into the mesh, if it is not there yet.
    pub(super) fn update(&mut self, picture: &HandPicture, setting: DrawSettings) {
        if self.drawn == Some((*picture, setting)) {
            return;
        }
        let mesh = Arc::make_mut(&mut self.mesh);
        draw(&mut self.sketch, picture, &setting, mesh);
        self.drawn = Some((*picture, setting));
        self.points = OnceCell::new();
    }

    fn find_points(&self, picture: &HandPicture, setting: &DrawSettings) -> HandPoints {
        let (camera, pose) = (setting.camera(picture.side), picture.pose());
        let base = |finger| {
            let first = match finger {
                Finger::Little => Segment::Little1,
                Finger::Ring => Segment::Ring1,
                Finger::Middle => Segment::Middle1,
                Finger::Index => Segment::Index1,
                Finger::Thumb => Segment::Thumb1,
            };
            pose.frame(first).translation
        };
        let is_seen = |finger: Finger, at: Pos2| {
            let seen = self.sketch.segment_at(&self.mesh, at);
            seen.is_some_and(|seen| seen.segment.finger() == Some(finger))
        };
        let along = |finger: Finger| {
            let end = pose.frame(Segment::tip(finger));
            let [out, _] = shape::pad_ways(finger);
            // The middle of the pad may lie at the edge of what is seen of its finger.
            let tip = pose.tip(finger) - end.matrix3 * out * INSIDE_MM;
            let (joint, base) = (end.translation, base(finger));
            let along = [
                tip,
                tip.lerp(joint, 0.5),
                joint,
                joint.lerp(base, 0.5),
                base,
            ];
            along.map(|at| Some(camera.place(at)).filter(|at| is_seen(finger, *at)))
        };
        let [little, index] = [Finger::Little, Finger::Index].map(|own| camera.place(base(own)).x);
        HandPoints {
            along: PerFinger::from_fn(along),
            bounds: camera.bounds,
            is_forward: little < index,
        }
    }

    /// Anchor points of the last drawn picture; `None` before the first one.
    pub(crate) fn points(&self) -> Option<HandPoints> {
        let (picture, setting) = self.drawn.as_ref()?;
        let found = || self.find_points(picture, setting);
        Some(*self.points.get_or_init(found))
    }

    /// Moves the default viewpoint to the frontal one or back, within [`EASE_S`]; at once if animations are off.
    pub(crate) fn face(&mut self, ui: &Ui, is_frontal: bool) {
        let eases = ui.style().animation_time > 0.0;
        let time_s = if eases { EASE_S } else { 0.0 };
        let id = ui.scope_id().with("frontal");
        let share = ui.ctx().animate_bool_with_time(id, is_frontal, time_s);
        self.front = emath::easing::cubic_in_out(share);
    }

    pub(crate) fn turn(&self, side: Side) -> Turn {
        self.turn
            .unwrap_or_else(|| TURN.towards(FRONT, self.front).of(side))
    }
}

impl DrawSettings {
    /// Camera of this picture. It never jumps while the hand moves.
    pub(crate) fn camera(&self, side: Side) -> Camera {
        // A small picture omits the wrist to give the fingers more room.
        let least = if self.is_small() { CUT_MM } else { f32::MIN };
        let mirror = side.frame();
        let reach = REACH
            .iter()
            .map(|at| mirror.transform_point3(at.with_z(at.z.max(least))));
        Camera::new(self.turn, self.rect, reach)
    }

    fn is_small(&self) -> bool {
        self.rect.height() < SMALL_POINTS
    }
}

/// Draws a picture into a mesh.
pub(crate) fn draw(
    sketch: &mut Sketch,
    picture: &HandPicture,
    setting: &DrawSettings,
    mesh: &mut Mesh,
) {
    let palette = Palette::of(setting.theme);
    let (camera, is_small) = (setting.camera(picture.side), setting.is_small());
    let (pose, parts) = picture.parts(palette, is_small);
    let mut light = Light::new(palette.studio, &camera, &pose);
    light.veil = picture.is_stale.then_some((palette.card, STALE_PART));
    let model = Model {
        camera: &camera,
        light: &light,
        parts: &parts,
        feather: setting.feather,
    };
    sketch.draw(model, mesh);
    if is_small {
        fade_out(&camera, mesh);
    }
}

/// Fades a picture out at its wrist.
pub(crate) fn fade_out(camera: &Camera, mesh: &mut Mesh) {
    let [cut, full] = [CUT_MM, CUT_MM + FADE_MM].map(|z| camera.place(Vec3::Z * z));
    let way = full - cut;
    for vertex in &mut mesh.vertices {
        let left = (vertex.pos - cut).dot(way) / way.length_sq().max(f32::MIN_POSITIVE);
        vertex.color = vertex.color.gamma_multiply(left.clamp(0.0, 1.0));
    }
}
