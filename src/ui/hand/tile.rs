//! Pictures of poses for tiles. Each is drawn once and cached for as long as it is shown unchanged.

use crate::app::settings::Theme;
use crate::draw::figure::camera::{Camera, Turn};
use crate::draw::figure::light::Light;
use crate::draw::figure::render::{Model, Sketch};
use crate::hand::kinematics::Side;
use crate::hand::{Dof, Finger, PerDof, PerFinger};
use crate::ui::hand::scene::HandPicture;
use crate::ui::hand::view::{CUT_MM, DrawSettings, HandView, draw, fade_out};
use crate::ui::kit::{Label, Look};
use crate::ui::text::Text;
use crate::ui::theme::Palette;
use egui::cache::{ComputerMut, FrameCache};
use egui::emath::{Float, OrderedFloat};
use egui::{Mesh, Pos2, Rect, Ui, vec2};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// From the side of the little finger and slightly below: straight fingers are visible side by side.
const FINGERS: Turn = turn(0.45, -0.18);
/// From the thumb's side, where its contacts and grip are visible.
const THUMB_SIDE: Turn = turn(-0.85, 0.12);
/// Nearly along the fingers' joints, where a ring of thumb and finger looks like a ring.
const RING_SIDE: Turn = turn(-1.3, 0.08);
/// From the side of the little finger, where hooked fingers are visible.
const LITTLE_SIDE: Turn = turn(1.15, 0.0);
/// A fist from the front, its thumb across it.
const FRONT: Turn = turn(0.3, 0.1);
/// The thumb, which points to the right, up.
const THUMB_UP: Turn = Turn {
    roll: FRAC_PI_2,
    ..turn(0.25, 0.1)
};
/// Share of the way to open at which a finger counts as straight, half bent (where the thumb meets it), or bent.
const STRAIGHT: f32 = 0.8;
const HALF: std::ops::RangeInclusive<f32> = 0.4..=0.6;
const BENT: f32 = 0.2;

/// Minimum height shown in a tile, in millimetres of the hand: a fist is not drawn much larger than an open hand.
const LEAST_MM: f32 = 145.0;

const fn turn(yaw: f32, pitch: f32) -> Turn {
    Turn {
        yaw,
        pitch,
        roll: 0.0,
    }
}

/// Draws a changing pose, for dry runs and editors, with a fixed viewpoint. `shares` of the way to open; a finger with an unknown
/// joint is a shell.
pub(crate) fn pose_ui(ui: &Ui, look: Look, rect: Rect, shares: &PerDof<Option<f32>>) {
    Tile::new(ui, look, rect, shares).paint(ui, rect);
}

/// Draws a pose to be recognised at the size of a button: from its best viewpoint, with the fingers that characterise it in
/// colour.
pub(crate) fn sign_ui(ui: &Ui, look: Look, rect: Rect, shares: &PerDof<Option<f32>>) {
    let mut tile = Tile::new(ui, look, rect, shares);
    tile.is_sign = true;
    tile.paint(ui, rect);
}

/// Page of an empty list: a hand, opened by `share` (0 closed, 1 open), over a title. The caller centres it.
pub(crate) fn empty_page_ui(ui: &mut Ui, look: Look, share: f32, title: Text) {
    ui.add_space(ui.available_height() * 0.2);
    let (_, picture) = ui.allocate_space(vec2(ui.available_width(), 160.0));
    pose_ui(ui, look, picture, &PerDof::splat(Some(share)));
    Label::text(look, title).large().ui(ui);
}

/// Cache key of a tile: its content and appearance.
#[derive(Clone, Copy, Hash)]
struct Tile {
    side: Side,
    shares: PerDof<Option<OrderedFloat<f32>>>,
    size: [OrderedFloat<f32>; 2],
    theme: Theme,
    feather: OrderedFloat<f32>,
    is_sign: bool,
}

impl Tile {
    fn new(ui: &Ui, look: Look, rect: Rect, shares: &PerDof<Option<f32>>) -> Self {
        Self {
            side: look.side,
            shares: shares.map(|share| share.map(Float::ord)),
            size: [rect.width().ord(), rect.height().ord()],
            theme: look.palette.theme,
            feather: (1.0 / ui.pixels_per_point()).ord(),
            is_sign: false,
        }
    }

    fn paint(self, ui: &Ui, rect: Rect) {
        type TileCache = FrameCache<Arc<Mesh>, PoseTiles>;
        let mesh = ui.memory_mut(|memory| Arc::clone(memory.caches.cache::<TileCache>().get(self)));
        let mut mesh = Mesh::clone(&mesh);
        mesh.translate(rect.min.to_vec2());
        ui.painter().with_clip_rect(rect).add(mesh);
    }
}

#[derive(Default)]
struct PoseTiles(Sketch);

impl ComputerMut<Tile, Arc<Mesh>> for PoseTiles {
    fn compute(&mut self, tile: Tile) -> Arc<Mesh> {
        let real = OrderedFloat::into_inner;
        let picture = HandPicture::of(tile.side, &tile.shares.map(|share| share.map(real)));
        let setting = DrawSettings {
            turn: HandView::default().turn(tile.side),
            rect: Rect::from_min_size(Pos2::ZERO, tile.size.map(real).into()),
            theme: tile.theme,
            feather: real(tile.feather),
        };
        let mut mesh = Mesh::default();
        if setting.rect.is_positive() {
            if tile.is_sign {
                draw_sign(&mut self.0, picture, setting, &mut mesh);
            } else {
                draw(&mut self.0, &picture, &setting, &mut mesh);
            }
        }
        Arc::new(mesh)
    }
}

/// Draws a pose at its full size, without the wrist, in light colours.
fn draw_sign(
    sketch: &mut Sketch,
    mut picture: HandPicture,
    setting: DrawSettings,
    mesh: &mut Mesh,
) {
    let turn;
    (turn, picture.marked) = seen_best(&picture.actual);
    let palette = Palette::of(setting.theme);
    let is_small = setting.rect.height() < 2.0 * CUT_MM;
    let (pose, parts) = picture.parts(palette, is_small);
    let corners = parts.iter().flat_map(|part| {
        let corners = part.solid.corners.iter();
        corners.map(|corner| part.frame.transform_point3(corner.at))
    });
    let seen: Vec<Vec3> = corners.map(|at| at.with_z(at.z.max(CUT_MM))).collect();
    let fit = |rect: Rect| Camera::new(turn.of(picture.side), rect, seen.iter().copied());
    let mut camera = fit(setting.rect);
    let most = setting.rect.height() / LEAST_MM;
    if camera.per_mm > most {
        let size = setting.rect.size() * (most / camera.per_mm);
        camera = fit(Rect::from_center_size(setting.rect.center(), size));
    }
    let light = Light::new(palette.signs, &camera, &pose);
    let model = Model {
        camera: &camera,
        light: &light,
        parts: &parts,
        feather: setting.feather,
    };
    sketch.draw(model, mesh);
    fade_out(&camera, mesh);
}

/// Returns the best viewpoint of a pose, and the fingers that characterise it: those in contact, else the straight ones.
fn seen_best(shares: &PerDof<Option<f32>>) -> (Turn, PerFinger<bool>) {
    let share = |dof: Dof| shares[dof].unwrap_or(1.0);
    let bend = |finger: Finger| share(finger.bend());
    let is_thumb = |finger: Finger| finger == Finger::Thumb;
    let others = || Finger::ALL.into_iter().filter(|finger| !is_thumb(*finger));
    let (thumb, swing) = (bend(Finger::Thumb), share(Dof::ThumbRotate));
    let touches = |finger: Finger| thumb < BENT && HALF.contains(&bend(finger));
    if others().any(touches) {
        let marked = PerFinger::from_fn(|finger| is_thumb(finger) || touches(finger));
        return (RING_SIDE, marked);
    }
    let is_fist = others().all(|finger| bend(finger) < BENT);
    if is_fist && thumb < BENT && swing > 0.5 {
        // The thumb is against the side of the index.
        let marked = PerFinger::from_fn(|finger| is_thumb(finger) || finger == Finger::Index);
        return (THUMB_SIDE, marked);
    }
    let is_out = thumb > STRAIGHT && swing > STRAIGHT;
    let marked = PerFinger::from_fn(|finger| match finger {
        Finger::Thumb => is_out,
        finger => bend(finger) > STRAIGHT,
    });
    let turn = if others().any(|finger| marked[finger]) {
        FINGERS
    } else if is_fist {
        if is_out { THUMB_UP } else { FRONT }
    } else if is_out {
        LITTLE_SIDE
    } else {
        THUMB_SIDE
    };
    let is_hook = !is_fist && turn == LITTLE_SIDE;
    (turn, marked.map(|is_marked| is_marked && !is_hook))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::poses::starter::starter;

    use Finger::{Index, Little, Middle, Ring, Thumb};

    #[test]
    fn each_shipped_pose_is_seen_from_where_it_is_told_from_others() {
        for (name, turn, marked) in [
            ("Open", FINGERS, &[Little, Ring, Middle, Index, Thumb][..]),
            ("Fist", FRONT, &[]),
            ("Point", FINGERS, &[Index]),
            ("V", FINGERS, &[Index, Middle]),
            ("OK", RING_SIDE, &[Index, Thumb]),
            ("Thumbs up", THUMB_UP, &[Thumb]),
            ("Rock", FINGERS, &[Little, Index]),
            ("Call", FINGERS, &[Little, Thumb]),
            ("Four", FINGERS, &[Little, Ring, Middle, Index]),
            ("Power grasp", THUMB_SIDE, &[]),
            ("Tripod", RING_SIDE, &[Index, Middle, Thumb]),
            ("Pinch", RING_SIDE, &[Index, Thumb]),
            ("Lateral", THUMB_SIDE, &[Index, Thumb]),
            ("Hook", LITTLE_SIDE, &[]),
        ] {
            let pose = starter()
                .poses
                .iter()
                .find(|pose| pose.name == name)
                .unwrap();
            let shares = pose
                .angles
                .map(|angle| Some(f32::from(angle.get()) / 1000.0));
            let (from, about) = seen_best(&shares);
            assert_eq!(from, turn, "{name}");
            for finger in Finger::ALL {
                assert_eq!(about[finger], marked.contains(&finger), "{name} {finger:?}");
            }
        }
    }

    #[test]
    fn a_thumb_that_is_up_is_seen_up_and_fills_its_tile_on_both_hands() {
        let mut shares = PerDof::splat(Some(0.0));
        shares[Dof::ThumbBend] = Some(1.0);
        shares[Dof::ThumbRotate] = Some(1.0);
        for side in [Side::Right, Side::Left] {
            let tile = Tile {
                side,
                shares: shares.map(|share| share.map(Float::ord)),
                size: [60.0, 56.0].map(Float::ord),
                theme: Theme::Dark,
                feather: 1.0_f32.ord(),
                is_sign: true,
            };
            let mesh = PoseTiles::default().compute(tile);
            let seen = mesh.vertices.iter().filter(|vertex| vertex.color.a() > 128);
            let blue = |color: egui::Color32| i16::from(color.b()) - i16::from(color.r()) > 60;
            let (thumb, rest): (Vec<_>, Vec<_>) = seen.partition(|vertex| blue(vertex.color));
            let top = |all: &[&egui::epaint::Vertex]| {
                all.iter()
                    .map(|vertex| vertex.pos.y)
                    .fold(f32::MAX, f32::min)
            };
            assert!(top(&thumb) < 3.0 && top(&rest) > 15.0, "{side:?}");
            let bounds = mesh.calc_bounds();
            assert!(bounds.height() > 48.0, "{bounds}");
        }
    }
}
