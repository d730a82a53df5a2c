//! The picture being drawn, its textures and its threads. Coverage of pixels is decided in the triangle module.

use crate::raster::number::{coordinate, floor, index};
use crate::raster::texture::Texture;
use crate::raster::tiles::{TILE, TileRows, Tiles};
use crate::raster::triangle::{Scissor, Strip, Triangle};
use egui::epaint::{ImageDelta, Primitive, Vertex};
use egui::{ClippedPrimitive, Mesh, Rect, TextureId, TexturesDelta};
use foldhash::fast::FixedState;
use std::collections::HashMap;
use std::hash::{BuildHasher, Hasher};
use std::ops::Range;
use std::panic::resume_unwind;

/// Threads that share a picture. Two: the smallest machine that we build and test on has two cores.
const THREADS: usize = 2;

/// A picture in memory and the textures for drawing it.
///
/// Meshes are drawn as by a GPU with egui's own shaders: pixels whose centre is inside, top-left rule on shared edges,
/// premultiplied blending in gamma space with 8 bits per channel. The bytes depend neither on the machine, the build or the
/// number of threads, nor on the previous picture, although only changes are drawn.
#[derive(Debug)]
pub struct Raster {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 4]>,
    textures: HashMap<TextureId, Texture>,
    returned: Vec<TextureId>,
    /// Counts the changes of textures.
    version: u64,
    tiles: Tiles,
    changed: Vec<Changed>,
    threads: usize,
}

/// A redrawn part of the picture, in pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changed {
    /// From left to right.
    pub columns: Range<usize>,
    /// From top to bottom.
    pub rows: Range<usize>,
}

impl Raster {
    /// A transparent picture of `width` x `height` pixels, without textures.
    pub fn new(width: u32, height: u32) -> Self {
        let mut raster = Self {
            width: 0,
            height: 0,
            pixels: Vec::new(),
            textures: HashMap::new(),
            returned: Vec::new(),
            version: 0,
            tiles: Tiles::default(),
            changed: Vec::new(),
            threads: THREADS,
        };
        raster.resize(width, height);
        raster
    }

    /// Resizes the picture, in pixels; its content is undefined until it is drawn.
    pub fn resize(&mut self, width: u32, height: u32) {
        let count = length(width).saturating_mul(length(height));
        if (self.width, self.height) != (width, height) {
            self.tiles.forget();
        }
        self.pixels.resize(count, [0; 4]);
        self.tiles.resize(length(width), length(height));
        (self.width, self.height) = (width, height);
    }

    /// Applies new and changed textures and empties `delta`, as egui requires for every frame, drawn or not. Textures freed by
    /// `delta` stay until [`Raster::free_textures`], because this frame may still use them.
    pub fn apply_textures(&mut self, delta: &mut TexturesDelta) {
        self.free_textures();
        for (id, changes) in delta.set.drain() {
            for change in changes {
                self.apply(id, &change);
            }
        }
        self.returned.extend(delta.free.drain());
    }

    /// Drops the textures freed by the last delta. Call it after drawing; the next delta does it too.
    pub fn free_textures(&mut self) {
        for id in self.returned.drain(..) {
            self.textures.remove(&id);
        }
    }

    /// Clears to `background` (premultiplied RGBA) and draws, both only where the picture changes. Paint callbacks and meshes
    /// without texture are skipped.
    pub fn draw(
        &mut self,
        primitives: &[ClippedPrimitive],
        pixels_per_point: f32,
        background: [u8; 4],
    ) {
        self.changed.clear();
        let width = length(self.width);
        let tile_rows = length(self.height)
            .div_ceil(TILE)
            .div_ceil(self.threads.max(1));
        if width == 0 || tile_rows == 0 {
            return;
        }
        let begun = u64::from(u32::from_le_bytes(background));
        let pixels = self.pixels.chunks_mut(width * tile_rows * TILE);
        let strips = pixels.zip(self.tiles.strips(tile_rows, begun));
        let textures = &self.textures;
        let mut draws = strips.enumerate().map(|(number, (pixels, tiles))| {
            let strip = Strip {
                first_row: coordinate(number * tile_rows * TILE),
                width,
                pixels,
            };
            move || {
                let meshes = meshes(primitives, pixels_per_point, textures);
                draw_strip(strip, tiles, &meshes, background)
            }
        });
        let changed = std::thread::scope(|scope| {
            // This thread draws the first part: the allocator keeps a heap for each further thread.
            let first = draws.next();
            let others: Vec<_> = draws.map(|draw| scope.spawn(draw)).collect();
            let first = first.map(|draw| draw());
            let others = others.into_iter().map(|other| other.join());
            let others = others.map(|other| other.unwrap_or_else(|panic| resume_unwind(panic)));
            first.into_iter().chain(others).collect::<Vec<_>>()
        });
        let (right, bottom) = (length(self.width), length(self.height));
        self.changed = changed.concat();
        for changed in &mut self.changed {
            changed.columns.end = changed.columns.end.min(right);
            changed.rows.end = changed.rows.end.min(bottom);
        }
    }

    /// Parts that the last [`Raster::draw`] redrew; all others are unchanged.
    pub fn changed(&self) -> &[Changed] {
        &self.changed
    }

    /// The picture: RGBA8, premultiplied (opaque where the background was), row by row from the top left.
    pub fn pixels(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// The picture without its alpha: RGB8, row by row from the top left.
    pub fn rgb(&self) -> Vec<u8> {
        let pixels = self.pixels.iter();
        pixels.flat_map(|[r, g, b, _]| [*r, *g, *b]).collect()
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn apply(&mut self, id: TextureId, change: &ImageDelta) {
        self.version += 1;
        match change.pos {
            None => {
                let texture = Texture::whole(change, self.version);
                self.textures.insert(id, texture);
            }
            Some(position) => {
                if let Some(texture) = self.textures.get_mut(&id) {
                    texture.patch(position, change, self.version);
                }
            }
        }
    }
}

fn length(pixels: u32) -> usize {
    usize::try_from(pixels).unwrap_or(usize::MAX)
}

/// A mesh that can be drawn.
struct Drawable<'a> {
    mesh: &'a Mesh,
    texture: &'a Texture,
    clip: Scissor,
    pixels_per_point: f32,
}

fn meshes<'a>(
    primitives: &'a [ClippedPrimitive],
    pixels_per_point: f32,
    textures: &'a HashMap<TextureId, Texture>,
) -> Vec<Drawable<'a>> {
    let drawable = |primitive: &'a ClippedPrimitive| {
        let Primitive::Mesh(mesh) = &primitive.primitive else {
            return None;
        };
        Some(Drawable {
            mesh,
            texture: textures.get(&mesh.texture_id)?,
            clip: scissor(primitive.clip_rect, pixels_per_point),
            pixels_per_point,
        })
    };
    primitives.iter().filter_map(drawable).collect()
}

impl Drawable<'_> {
    /// Its triangles that touch these pixels, in drawing order.
    fn triangles(&self, strip: Scissor) -> impl Iterator<Item = Triangle> {
        let clip = self.clip.within(strip);
        let corners = self.mesh.indices.chunks_exact(3);
        clip.into_iter().flat_map(move |clip| {
            let corners = corners.clone();
            corners.filter_map(move |corners| {
                let [a, b, c] = corners else { return None };
                Triangle::new([self.vertex(*a)?, self.vertex(*b)?, self.vertex(*c)?], clip)
            })
        })
    }

    fn vertex(&self, at: u32) -> Option<(Vertex, [f32; 2])> {
        let vertex = *self.mesh.vertices.get(length(at))?;
        let position = [vertex.pos.x, vertex.pos.y].map(|points| points * self.pixels_per_point);
        Some((vertex, position))
    }
}

/// Draws the changes of a strip and returns them.
fn draw_strip(
    mut strip: Strip<'_>,
    mut tiles: TileRows<'_>,
    meshes: &[Drawable<'_>],
    background: [u8; 4],
) -> Vec<Changed> {
    let bounds = strip.bounds();
    let hashers = FixedState::default();
    for mesh in meshes {
        for triangle in mesh.triangles(bounds) {
            let mut hasher = hashers.build_hasher();
            hasher.write_u64(mesh.texture.version);
            tiles.note(triangle.bounds, triangle.fingerprint(hasher));
        }
    }
    let changes = tiles.changes();
    for change in &changes {
        strip.clear(*change, background);
    }
    if !changes.is_empty() {
        for mesh in meshes {
            for triangle in mesh.triangles(bounds) {
                triangle.paint(&mut strip, mesh.texture, &changes);
            }
        }
    }
    let pixels = |from: i64, to: i64| index(from)..index(to);
    let changed = |change: Scissor| Changed {
        columns: pixels(change.left, change.right),
        rows: pixels(change.top, change.bottom),
    };
    changes.into_iter().map(changed).collect()
}

/// The clip rectangle, rounded to whole pixels.
fn scissor(clip: Rect, pixels_per_point: f32) -> Scissor {
    let pixel = |points: f32| floor((points * pixels_per_point).round());
    Scissor {
        left: pixel(clip.min.x),
        top: pixel(clip.min.y),
        right: pixel(clip.max.x),
        bottom: pixel(clip.max.y),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::cast_precision_loss, reason = "a test may")]

    use egui::{Color32, ColorImage, TextureOptions, pos2, vec2};

    use super::*;

    const BLACK: [u8; 4] = [0, 0, 0, 255];
    const CLIP: Rect = Rect::EVERYTHING;

    fn white() -> TexturesDelta {
        let mut delta = TexturesDelta::default();
        let image = ColorImage::filled([1, 1], Color32::WHITE);
        delta.push(
            TextureId::default(),
            ImageDelta::full(image, TextureOptions::LINEAR),
        );
        delta
    }

    fn raster(width: u32, height: u32) -> Raster {
        let mut raster = Raster::new(width, height);
        raster.apply_textures(&mut white());
        raster
    }

    fn quad(corners: [[f32; 2]; 4], colour: Color32) -> Mesh {
        let mut mesh = Mesh::default();
        for [x, y] in corners {
            mesh.colored_vertex(pos2(x, y), colour);
        }
        mesh.indices = vec![0, 1, 2, 2, 3, 0];
        mesh
    }

    fn clipped(mesh: Mesh, clip_rect: Rect) -> ClippedPrimitive {
        ClippedPrimitive {
            clip_rect,
            primitive: Primitive::Mesh(mesh),
        }
    }

    fn count(raster: &Raster, colour: [u8; 4]) -> usize {
        raster
            .pixels()
            .chunks_exact(4)
            .filter(|pixel| *pixel == colour)
            .count()
    }

    #[test]
    fn shared_edge_is_neither_doubled_nor_missed() {
        let half = Color32::from_rgba_premultiplied(128, 128, 128, 128);
        let shapes = [
            [[2.0, 3.0], [60.0, 3.0], [60.0, 50.0], [2.0, 50.0]],
            [[2.5, 3.5], [60.5, 3.5], [60.5, 50.5], [2.5, 50.5]],
            [[30.0, 1.0], [61.0, 30.3], [32.2, 60.0], [1.5, 28.7]],
        ];
        for corners in shapes {
            for turn in 0..4 {
                let mut corners = corners;
                corners.rotate_left(turn);
                let mut raster = raster(64, 64);
                raster.draw(&[clipped(quad(corners, half), CLIP)], 1.0, BLACK);
                let once = count(&raster, [128, 128, 128, 255]);
                assert_eq!(once + count(&raster, BLACK), 64 * 64, "{corners:?}");
                assert!(once > 1500, "{once}");
                let mut holes = 0;
                for row in raster.pixels().chunks_exact(64 * 4) {
                    let lit: Vec<usize> = (0..64).filter(|x| row[x * 4] != 0).collect();
                    if let (Some(first), Some(last)) = (lit.first(), lit.last()) {
                        holes += last - first + 1 - lit.len();
                    }
                }
                assert_eq!(holes, 0, "{corners:?}");
            }
        }
    }

    #[test]
    fn opaque_rectangle_fills_exactly_its_pixels() {
        let mut raster = raster(20, 20);
        let corners = [[3.0, 4.0], [9.0, 4.0], [9.0, 15.0], [3.0, 15.0]];
        raster.draw(&[clipped(quad(corners, Color32::RED), CLIP)], 1.0, BLACK);
        for (at, pixel) in raster.pixels().chunks_exact(4).enumerate() {
            let inside = (3..9).contains(&(at % 20)) && (4..15).contains(&(at / 20));
            assert_eq!(pixel == [255, 0, 0, 255], inside, "pixel {at}");
        }
    }

    #[test]
    fn scissor_cuts_at_rounded_pixels() {
        let mut raster = raster(20, 20);
        let everywhere = quad(
            [[-9.0, -9.0], [99.0, -9.0], [99.0, 99.0], [-9.0, 99.0]],
            Color32::RED,
        );
        let clip = Rect::from_min_max(pos2(1.3, 2.2), pos2(3.2, 5.3));
        raster.draw(&[clipped(everywhere, clip)], 2.0, BLACK);
        for (at, pixel) in raster.pixels().chunks_exact(4).enumerate() {
            let inside = (3..6).contains(&(at % 20)) && (4..11).contains(&(at / 20));
            assert_eq!(pixel == [255, 0, 0, 255], inside, "pixel {at}");
        }
    }

    #[test]
    fn nearest_keeps_texels_and_linear_smooths_them() {
        for (options, shades) in [(TextureOptions::NEAREST, 2), (TextureOptions::LINEAR, 5)] {
            let mut raster = Raster::new(8, 1);
            let mut delta = TexturesDelta::default();
            let image = ColorImage::new([2, 1], vec![Color32::BLACK, Color32::WHITE]);
            delta.push(TextureId::default(), ImageDelta::full(image, options));
            raster.apply_textures(&mut delta);
            let mut mesh = Mesh::default();
            let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(1.0, 1.0));
            let place = Rect::from_min_size(pos2(0.0, 0.0), vec2(8.0, 1.0));
            mesh.add_rect_with_uv(place, whole, Color32::WHITE);
            raster.draw(&[clipped(mesh, CLIP)], 1.0, BLACK);
            let mut reds: Vec<u8> = raster.pixels().iter().step_by(4).copied().collect();
            assert!(reds.is_sorted(), "{reds:?}");
            reds.dedup();
            assert_eq!(
                reds.len() >= shades,
                shades == 5 || reds == [0, 255],
                "{reds:?}"
            );
            assert_eq!(reds.len() == 2, shades == 2, "{reds:?}");
        }
    }

    #[test]
    fn gradient_runs_from_corner_to_corner() {
        let mut raster = raster(256, 2);
        let mut mesh = quad(
            [[0.0, 0.0], [256.0, 0.0], [256.0, 2.0], [0.0, 2.0]],
            Color32::BLACK,
        );
        mesh.vertices[1].color = Color32::WHITE;
        mesh.vertices[2].color = Color32::WHITE;
        raster.draw(&[clipped(mesh, CLIP)], 1.0, BLACK);
        for (x, pixel) in raster.pixels().chunks_exact(4).take(256).enumerate() {
            let wanted = (x as f32 + 0.5) / 256.0 * 255.0;
            assert!(
                (f32::from(pixel[0]) - wanted).abs() <= 0.51,
                "{x}: {pixel:?}"
            );
        }
    }

    /// A shaded, half transparent quadrangle somewhere, the same for each number.
    fn shaded(number: u64) -> ClippedPrimitive {
        let mut random = fastrand::Rng::with_seed(number);
        let mut point = || [random.f32() * 120.0 - 10.0, random.f32() * 80.0 - 10.0];
        let corners = [point(), point(), point(), point()];
        let half = Color32::from_rgba_unmultiplied(random.u8(..), random.u8(..), 90, random.u8(..));
        let mut mesh = quad(corners, half);
        mesh.vertices[1].color = Color32::TRANSPARENT;
        clipped(mesh, CLIP)
    }

    #[test]
    fn what_changed_is_drawn_anew_and_looks_as_if_all_had_been() {
        let small = Rect::from_min_max(pos2(70.0, 3.0), pos2(90.0, 20.0));
        let mut shapes: Vec<_> = (0..40).map(shaded).collect();
        let mut kept = raster(97, 61);
        kept.draw(&shapes, 1.0, BLACK);
        for round in 40..80 {
            let before = kept.pixels().to_vec();
            match round % 4 {
                0 => shapes.truncate(20),
                1 => shapes.push(shaded(round)),
                2 => shapes.swap(1, 2),
                _ => {
                    shapes[5] = shaded(round);
                    shapes[5].clip_rect = small;
                }
            }
            kept.draw(&shapes, 1.0, BLACK);
            let mut fresh = raster(97, 61);
            fresh.draw(&shapes, 1.0, BLACK);
            assert!(kept.pixels() == fresh.pixels(), "round {round}");
            let is_told = |at: usize| {
                let (column, row) = (at % 97, at / 97);
                let mut changed = kept.changed().iter();
                changed.any(|part| part.columns.contains(&column) && part.rows.contains(&row))
            };
            let pixels = kept.pixels().chunks_exact(4).zip(before.chunks_exact(4));
            for (at, (new, old)) in pixels.enumerate() {
                assert!(new == old || is_told(at), "round {round}, pixel {at}");
            }
        }
    }

    #[test]
    fn what_stays_is_not_drawn_again() {
        let mut kept = raster(320, 320);
        let still = quad(
            [[0.0, 0.0], [320.0, 0.0], [320.0, 320.0], [0.0, 320.0]],
            Color32::BLUE,
        );
        let moving = |x: f32| {
            let corners = [[x, 40.0], [x + 9.0, 40.0], [x + 9.0, 50.0], [x, 50.0]];
            clipped(quad(corners, Color32::RED), CLIP)
        };
        let still = clipped(still, CLIP);
        kept.draw(&[still.clone(), moving(40.0)], 1.0, BLACK);
        assert_eq!(drawn(&kept), 320 * 320);
        kept.draw(&[still.clone(), moving(40.0)], 1.0, BLACK);
        assert_eq!(drawn(&kept), 0);
        kept.draw(&[still.clone(), moving(42.0)], 1.0, BLACK);
        assert_eq!(drawn(&kept), TILE * TILE, "the tile on which it moved");
        kept.apply_textures(&mut white());
        kept.draw(&[still.clone(), moving(42.0)], 1.0, BLACK);
        assert_eq!(drawn(&kept), 320 * 320, "a texture that changed");
        kept.draw(&[still, moving(42.0)], 1.0, [9, 9, 9, 255]);
        assert_eq!(drawn(&kept), 320 * 320, "another background");
    }

    /// Pixels that were drawn anew.
    fn drawn(raster: &Raster) -> usize {
        let changed = raster.changed().iter();
        changed
            .map(|part| part.columns.len() * part.rows.len())
            .sum()
    }

    #[test]
    fn thread_count_does_not_change_bytes() {
        let pictures = [1, 2, 3, 7].map(|threads| {
            let mut raster = raster(97, 61);
            raster.threads = threads;
            let shapes: Vec<_> = (0..200).map(shaded).collect();
            raster.draw(&shapes, 1.0, BLACK);
            raster.pixels().to_vec()
        });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]));
        assert!(pictures[0].iter().any(|byte| *byte != pictures[0][0]));
    }

    #[test]
    fn returned_texture_shows_once_more_then_goes() {
        let mut raster = raster(4, 4);
        let mut delta = TexturesDelta::default();
        delta.free(TextureId::default());
        raster.apply_textures(&mut delta);
        assert!(delta.is_empty());
        let all = [clipped(
            quad(
                [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]],
                Color32::RED,
            ),
            CLIP,
        )];
        raster.draw(&all, 1.0, BLACK);
        assert_eq!(count(&raster, [255, 0, 0, 255]), 16);
        raster.free_textures();
        raster.draw(&all, 1.0, BLACK);
        assert_eq!(count(&raster, BLACK), 16);
    }

    #[test]
    fn broken_meshes_paint_nothing() {
        let mut raster = raster(4, 4);
        let nan = quad(
            [[f32::NAN, 0.0], [4.0, 0.0], [4.0, f32::NAN], [0.0, 4.0]],
            Color32::RED,
        );
        let mut loose = quad(
            [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]],
            Color32::RED,
        );
        loose.indices = vec![0, 1, 9, 0, 1];
        raster.draw(&[clipped(nan, CLIP), clipped(loose, CLIP)], 1.0, BLACK);
        assert_eq!(count(&raster, BLACK), 16);
    }
}
