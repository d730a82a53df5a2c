//! Poses alone, for tiles: each drawn once and kept from frame to frame as long as it is the same.

use crate::app::settings::Theme;
use crate::hand::PerDof;
use crate::hand::kinematics::Side;
use crate::ui::hand::render::Sketch;
use crate::ui::hand::scene::HandPicture;
use crate::ui::hand::view::{DrawSettings, HandView, draw};
use crate::ui::theme::Palette;
use egui::cache::{ComputerMut, FrameCache};
use egui::emath::{Float, OrderedFloat};
use egui::{Mesh, Pos2, Rect, Ui};
use std::sync::Arc;

/// Draws a pose alone, for tiles: kept from frame to frame as long as it is the same.
pub(crate) fn pose_ui(ui: &Ui, palette: &Palette, rect: Rect, picture: &HandPicture) {
    let tile = Tile {
        side: picture.side,
        shares: picture.actual.map(|share| share.map(Float::ord)),
        size: [rect.width().ord(), rect.height().ord()],
        theme: palette.theme,
        feather: (1.0 / ui.pixels_per_point()).ord(),
    };
    type Kept = FrameCache<Arc<Mesh>, Tiles>;
    let mesh = ui.memory_mut(|memory| Arc::clone(memory.caches.cache::<Kept>().get(tile)));
    let mut mesh = Mesh::clone(&mesh);
    mesh.translate(rect.min.to_vec2());
    ui.painter().with_clip_rect(rect).add(mesh);
}

/// What a tile shows, and how.
#[derive(Clone, Copy, Hash)]
struct Tile {
    side: Side,
    shares: PerDof<Option<OrderedFloat<f32>>>,
    size: [OrderedFloat<f32>; 2],
    theme: Theme,
    feather: OrderedFloat<f32>,
}

#[derive(Default)]
struct Tiles(Sketch);

impl ComputerMut<Tile, Arc<Mesh>> for Tiles {
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
            draw(&mut self.0, &picture, &setting, &mut mesh);
        }
        Arc::new(mesh)
    }
}
