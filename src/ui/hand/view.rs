//! From where the hand is looked at: turned by dragging, drawn again only when something of it changed.

use crate::app::settings::Theme;
use crate::hand::Dof;
use crate::hand::kinematics::{Segment, Side};
use crate::ui::hand::camera::{Camera, Turn};
use crate::ui::hand::light::Light;
use crate::ui::hand::reach::REACH;
use crate::ui::hand::render::{Model, Sketch};
use crate::ui::hand::scene::HandPicture;
use crate::ui::theme::Palette;
use egui::{Mesh, Rect, Response, Shape, Ui};
use std::sync::Arc;

/// From where the hand is looked at if nobody turned it: from the side of the little finger and a little below, so that
/// bending is seen as bending, and a pinch as a ring.
pub(crate) const TURN: Turn = Turn {
    yaw: 0.45,
    pitch: -0.18,
};
/// Radians of turning for a point of dragging, and how far it can be tipped.
const TURN_RAD: f32 = 0.01;
const PITCH_MAX_RAD: f32 = 1.2;
/// How far old values fade towards the card.
const STALE_PART: f32 = 0.55;
/// Height of a picture below which fewer triangles do.
const SMALL_POINTS: f32 = 110.0;
/// Where such a picture ends below.
const CUT_MM: f32 = 42.0;
/// The part of its height over which it fades there.
const FADE_PART: f32 = 0.16;
/// From where a hand is looked at, and what was drawn last.
#[derive(Debug, Clone, Default)]
pub(crate) struct HandView {
    /// Nobody turned it where there is none.
    pub(crate) turn: Option<Turn>,
    pub(crate) drawn: Option<(HandPicture, DrawSettings)>,
    sketch: Sketch,
    mesh: Arc<Mesh>,
}

/// Where and how a picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawSettings {
    pub(crate) turn: Turn,
    pub(crate) rect: Rect,
    pub(crate) theme: Theme,
    /// Points of a pixel: the width of soft edges.
    pub(crate) feather: f32,
}

impl HandView {
    /// Draws the hand. A drag turns it, a double click turns it back.
    pub(crate) fn ui(
        &mut self,
        ui: &Ui,
        response: Response,
        palette: &Palette,
        picture: &HandPicture,
    ) -> (Response, Option<Dof>) {
        let rect = response.rect;
        if response.dragged() {
            let by = response.drag_delta() * TURN_RAD;
            let Turn { yaw, pitch } = self.turn(picture.side);
            let pitch = (pitch + by.y).clamp(-PITCH_MAX_RAD, PITCH_MAX_RAD);
            self.turn = Some(Turn {
                yaw: yaw - by.x,
                pitch,
            });
        }
        if response.double_clicked() {
            self.turn = None;
        }
        let joint = response.hover_pos().filter(|_| !response.dragged());
        let joint = joint
            .and_then(|at| self.sketch.segment_at(&self.mesh, at))
            .and_then(Segment::dof);
        let picture = HandPicture {
            lit: joint.or(picture.lit),
            ..*picture
        };
        self.paint(ui, rect, palette, &picture);
        (response, joint)
    }

    /// Draws the hand as it was turned last.
    pub(crate) fn paint(&mut self, ui: &Ui, rect: Rect, palette: &Palette, picture: &HandPicture) {
        let setting = DrawSettings {
            turn: self.turn(picture.side),
            rect,
            theme: palette.theme,
            feather: 1.0 / ui.pixels_per_point(),
        };
        if rect.is_positive() && self.drawn != Some((*picture, setting)) {
            let mesh = Arc::make_mut(&mut self.mesh);
            draw(&mut self.sketch, picture, &setting, mesh);
            self.drawn = Some((*picture, setting));
        }
        ui.painter()
            .with_clip_rect(rect)
            .add(Shape::Mesh(Arc::clone(&self.mesh)));
    }

    pub(crate) fn turn(&self, side: Side) -> Turn {
        let default = match side {
            Side::Right => TURN,
            Side::Left => Turn {
                yaw: -TURN.yaw,
                ..TURN
            },
        };
        self.turn.unwrap_or(default)
    }
}

pub(crate) fn draw(
    sketch: &mut Sketch,
    picture: &HandPicture,
    setting: &DrawSettings,
    mesh: &mut Mesh,
) {
    let palette = Palette::of(setting.theme);
    let is_small = setting.rect.height() < SMALL_POINTS;
    // A small picture leaves the wrist out, for the sake of the fingers.
    let least = if is_small { CUT_MM } else { f32::MIN };
    let mirror = picture.side.frame();
    let reach = REACH
        .iter()
        .map(|at| mirror.transform_point3(at.with_z(at.z.max(least))));
    let camera = Camera::new(setting.turn, setting.rect, reach);
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
        let (bottom, fade) = (setting.rect.bottom(), setting.rect.height() * FADE_PART);
        for vertex in &mut mesh.vertices {
            let left = ((bottom - vertex.pos.y) / fade).clamp(0.0, 1.0);
            vertex.color = vertex.color.gamma_multiply(left);
        }
    }
}
