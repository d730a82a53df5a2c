//! Textures: whole and partial updates, GPU-like sampling. No drawing.

use egui::epaint::ImageDelta;
use egui::{ImageData, TextureFilter, TextureOptions, TextureWrapMode};

use crate::raster::number::{coordinate, floor, index, texels};

/// One texture, RGBA8 with premultiplied alpha, row-major.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Texture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
    options: TextureOptions,
    /// Unique for each texture and each of its contents.
    pub(crate) version: u64,
}

impl Texture {
    /// Creates a texture from a whole update.
    pub(crate) fn whole(delta: &ImageDelta, version: u64) -> Self {
        let ImageData::Color(image) = &delta.image;
        Self {
            width: image.width(),
            height: image.height(),
            pixels: image.pixels.iter().map(|pixel| pixel.to_array()).collect(),
            options: delta.options,
            version,
        }
    }

    /// Overwrites the region at `position` (x, y in texels), clipped to the texture.
    pub(crate) fn patch(&mut self, position: [usize; 2], delta: &ImageDelta, version: u64) {
        let ImageData::Color(image) = &delta.image;
        (self.options, self.version) = (delta.options, version);
        let [left, top] = position;
        if image.width() == 0 || left >= self.width {
            return;
        }
        let rows = self.pixels.chunks_exact_mut(self.width).skip(top);
        for (row, source) in rows.zip(image.pixels.chunks_exact(image.width())) {
            for (pixel, new) in row.iter_mut().skip(left).zip(source) {
                *pixel = new.to_array();
            }
        }
    }

    /// Width and height as factors that convert `uv` to texels.
    pub(crate) fn scale(&self) -> [f32; 2] {
        [texels(self.width), texels(self.height)]
    }

    /// The colour at (`x`, `y`) in texels, channels 0..=255. An empty texture is transparent.
    pub(crate) fn sample(&self, x: f32, y: f32) -> [f32; 4] {
        // Minified pictures use the same filter: the program never sets two different ones.
        match self.options.magnification {
            TextureFilter::Nearest => self.texel(floor(x), floor(y)),
            TextureFilter::Linear => self.bilinear(x - 0.5, y - 0.5),
        }
    }

    fn bilinear(&self, x: f32, y: f32) -> [f32; 4] {
        let (right, down) = (x - x.floor(), y - y.floor());
        let (column, row) = (floor(x), floor(y));
        let first = self.texel(column, row);
        // Glyphs are aligned to whole pixels: most samples hit a texel's centre.
        if right == 0.0 && down == 0.0 {
            return first;
        }
        let top = mix(first, self.texel(column + 1, row), right);
        let bottom = mix(
            self.texel(column, row + 1),
            self.texel(column + 1, row + 1),
            right,
        );
        mix(top, bottom, down)
    }

    fn texel(&self, column: i64, row: i64) -> [f32; 4] {
        let column = wrap(column, self.width, self.options.wrap_mode);
        let row = wrap(row, self.height, self.options.wrap_mode);
        let pixel = self.pixels.get(row * self.width + column);
        pixel.copied().unwrap_or_default().map(f32::from)
    }
}

fn mix(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    let [a0, a1, a2, a3] = a;
    let [b0, b1, b2, b3] = b;
    [
        a0 + (b0 - a0) * share,
        a1 + (b1 - a1) * share,
        a2 + (b2 - a2) * share,
        a3 + (b3 - a3) * share,
    ]
}

fn wrap(at: i64, size: usize, mode: TextureWrapMode) -> usize {
    let size = coordinate(size).max(1);
    index(match mode {
        TextureWrapMode::ClampToEdge => at.clamp(0, size - 1),
        TextureWrapMode::Repeat => at.rem_euclid(size),
        TextureWrapMode::MirroredRepeat => {
            let there_and_back = at.rem_euclid(2 * size);
            there_and_back.min(2 * size - 1 - there_and_back)
        }
    })
}

#[cfg(test)]
mod tests {
    use egui::{Color32, ColorImage};

    use super::*;

    fn two_texels(options: TextureOptions) -> Texture {
        let image = ColorImage::new([2, 1], vec![Color32::BLACK, Color32::WHITE]);
        Texture::whole(&ImageDelta::full(image, options), 1)
    }

    #[test]
    fn linear_blends_between_centres_and_nearest_does_not() {
        let linear = two_texels(TextureOptions::LINEAR);
        let nearest = two_texels(TextureOptions::NEAREST);
        let rows = [
            (0.5, 0.0, 0.0),
            (1.0, 127.5, 255.0),
            (0.99, 124.95, 0.0),
            (1.5, 255.0, 255.0),
            (-3.0, 0.0, 0.0),
            (9.0, 255.0, 255.0),
        ];
        for (x, smooth, crisp) in rows {
            let [got, ..] = linear.sample(x, 0.5);
            assert!((got - smooth).abs() < 0.01, "linear at {x}: {got}");
            let [got, ..] = nearest.sample(x, 0.5);
            assert!((got - crisp).abs() < 0.01, "nearest at {x}: {got}");
        }
    }

    #[test]
    fn wrap_modes_continue_past_the_edge() {
        let rows = [
            (TextureWrapMode::ClampToEdge, [0, 0, 1, 1]),
            (TextureWrapMode::Repeat, [1, 0, 0, 1]),
            (TextureWrapMode::MirroredRepeat, [0, 0, 1, 0]),
        ];
        for (mode, wanted) in rows {
            assert_eq!(
                [-1, 0, 2, 3].map(|at| wrap(at, 2, mode)),
                wanted,
                "{mode:?}"
            );
        }
    }

    #[test]
    fn partial_update_changes_only_its_region() {
        let blank = ColorImage::filled([3, 3], Color32::BLACK);
        let mut texture = Texture::whole(&ImageDelta::full(blank, TextureOptions::NEAREST), 1);
        let patch = ColorImage::filled([2, 1], Color32::WHITE);
        texture.patch(
            [1, 2],
            &ImageDelta::partial([1, 2], patch, TextureOptions::NEAREST),
            2,
        );
        let white: Vec<usize> = (0..9)
            .filter(|&at| texture.pixels.get(at) == Some(&[255; 4]))
            .collect();
        assert_eq!(white, [7, 8]);
    }
}
