//! The picture being drawn, its textures and its threads. Which pixels a triangle covers is not decided here.

use std::collections::HashMap;

use egui::epaint::{ImageDelta, Primitive, Vertex};
use egui::{ClippedPrimitive, Mesh, Rect, TextureId, TexturesDelta};

use crate::shell::raster::number::{coordinate, floor};
use crate::shell::raster::texture::Texture;
use crate::shell::raster::triangle::{Scissor, Strip, paint};

/// Threads that share a picture. Two: the smallest machine we build and test on has two cores.
const THREADS: usize = 2;

/// A picture in memory and the textures to draw it with.
///
/// Meshes are drawn like a GPU would with egui's own shaders: pixels whose centre is inside, top-left rule on shared
/// edges, premultiplied blending in gamma space with 8 bits a channel. The bytes do not depend on the machine,
/// the build or the number of threads.
#[derive(Debug)]
pub struct Raster {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 4]>,
    textures: HashMap<TextureId, Texture>,
    returned: Vec<TextureId>,
    threads: usize,
}

impl Raster {
    /// A transparent picture of `width` x `height` pixels, without textures.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        let mut raster = Self {
            width: 0,
            height: 0,
            pixels: Vec::new(),
            textures: HashMap::new(),
            returned: Vec::new(),
            threads: THREADS,
        };
        raster.resize(width, height);
        raster
    }

    /// Gives the picture another size in pixels; what it shows is undefined until it is drawn.
    pub fn resize(&mut self, width: u32, height: u32) {
        let count = length(width).saturating_mul(length(height));
        self.pixels.resize(count, [0; 4]);
        (self.width, self.height) = (width, height);
    }

    /// Takes over new and changed textures and leaves `delta` empty, as egui demands for every frame, drawn or not.
    /// Textures which `delta` gives back stay until [`Raster::free_textures`], for this frame may still show them.
    pub fn apply_textures(&mut self, delta: &mut TexturesDelta) {
        self.free_textures();
        for (id, changes) in delta.set.drain() {
            for change in changes {
                self.apply(id, &change);
            }
        }
        self.returned.extend(delta.free.drain());
    }

    /// Drops the textures given back with the last delta. To be called after drawing; the next delta does it too.
    pub fn free_textures(&mut self) {
        for id in self.returned.drain(..) {
            self.textures.remove(&id);
        }
    }

    /// Clears to `background` (premultiplied RGBA) and draws. Paint callbacks and meshes without texture are left out.
    pub fn draw(
        &mut self,
        primitives: &[ClippedPrimitive],
        pixels_per_point: f32,
        background: [u8; 4],
    ) {
        self.pixels.fill(background);
        let width = length(self.width);
        let rows = length(self.height).div_ceil(self.threads.max(1));
        if width == 0 || rows == 0 {
            return;
        }
        let textures = &self.textures;
        let strips = self.pixels.chunks_mut(width * rows);
        std::thread::scope(|scope| {
            for (number, pixels) in strips.enumerate() {
                let first_row = coordinate(number * rows);
                scope.spawn(move || {
                    let mut strip = Strip {
                        first_row,
                        width,
                        pixels,
                    };
                    draw_strip(&mut strip, primitives, pixels_per_point, textures);
                });
            }
        });
    }

    /// The picture: RGBA8, premultiplied (opaque where the background was), row by row from the top left.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn apply(&mut self, id: TextureId, change: &ImageDelta) {
        match change.pos {
            None => {
                self.textures.insert(id, Texture::whole(change));
            }
            Some(position) => {
                if let Some(texture) = self.textures.get_mut(&id) {
                    texture.patch(position, change);
                }
            }
        }
    }
}

fn length(pixels: u32) -> usize {
    usize::try_from(pixels).unwrap_or(usize::MAX)
}

fn draw_strip(
    strip: &mut Strip<'_>,
    primitives: &[ClippedPrimitive],
    pixels_per_point: f32,
    textures: &HashMap<TextureId, Texture>,
) {
    for primitive in primitives {
        let scissor = scissor(primitive.clip_rect, pixels_per_point, strip.bounds());
        let Primitive::Mesh(mesh) = &primitive.primitive else {
            continue;
        };
        if let Some(texture) = textures.get(&mesh.texture_id)
            && scissor.left < scissor.right
            && scissor.top < scissor.bottom
        {
            draw_mesh(strip, scissor, texture, (mesh, pixels_per_point));
        }
    }
}

fn draw_mesh(
    strip: &mut Strip<'_>,
    scissor: Scissor,
    texture: &Texture,
    (mesh, pixels_per_point): (&Mesh, f32),
) {
    let vertex = |at: &u32| -> Option<(Vertex, [f32; 2])> {
        let vertex = *mesh.vertices.get(usize::try_from(*at).ok()?)?;
        let position = [
            vertex.pos.x * pixels_per_point,
            vertex.pos.y * pixels_per_point,
        ];
        Some((vertex, position))
    };
    for corners in mesh.indices.chunks_exact(3) {
        if let [a, b, c] = corners
            && let (Some(a), Some(b), Some(c)) = (vertex(a), vertex(b), vertex(c))
        {
            paint(strip, scissor, texture, [a, b, c]);
        }
    }
}

/// The clip rectangle in whole pixels, nearest, inside `bounds`.
fn scissor(clip: Rect, pixels_per_point: f32, bounds: Scissor) -> Scissor {
    let pixel = |points: f32| floor((points * pixels_per_point).round());
    Scissor {
        left: bounds.left.max(pixel(clip.min.x)),
        top: bounds.top.max(pixel(clip.min.y)),
        right: bounds.right.min(pixel(clip.max.x)),
        bottom: bounds.bottom.min(pixel(clip.max.y)),
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

    #[test]
    fn thread_count_does_not_change_bytes() {
        let pictures = [1, 2, 3, 7].map(|threads| {
            let mut raster = raster(97, 61);
            raster.threads = threads;
            let mut shapes = Vec::new();
            let mut random = fastrand::Rng::with_seed(7);
            for _ in 0..200 {
                let mut point = || [random.f32() * 120.0 - 10.0, random.f32() * 80.0 - 10.0];
                let corners = [point(), point(), point(), point()];
                let half = Color32::from_rgba_unmultiplied(
                    random.u8(..),
                    random.u8(..),
                    90,
                    random.u8(..),
                );
                let mut mesh = quad(corners, half);
                mesh.vertices[1].color = Color32::TRANSPARENT;
                shapes.push(clipped(mesh, CLIP));
            }
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
