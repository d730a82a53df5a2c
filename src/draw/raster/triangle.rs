//! Draws one triangle into a strip of rows: coverage, colour, blending. Stores no textures.

use crate::raster::number::{
    HALF_PIXEL, SUBPIXELS, channel, coordinate, fixed, index, narrow, real, texels,
};
use crate::raster::texture::Texture;
use egui::Color32;
use egui::epaint::Vertex;
use std::hash::Hasher;

/// Whole pixels that may be painted: `left..right`, `top..bottom`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Scissor {
    pub(crate) left: i64,
    pub(crate) top: i64,
    pub(crate) right: i64,
    pub(crate) bottom: i64,
}

impl Scissor {
    /// Intersection; `None` if it is empty.
    pub(crate) fn within(self, other: Self) -> Option<Self> {
        let both = Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        };
        (both.left < both.right && both.top < both.bottom).then_some(both)
    }
}

/// Adjacent rows of the picture, owned by one thread.
#[derive(Debug)]
pub(crate) struct Strip<'a> {
    pub(crate) first_row: i64,
    pub(crate) width: usize,
    pub(crate) pixels: &'a mut [[u8; 4]],
}

impl Strip<'_> {
    fn span(&mut self, row: i64, left: i64, right: i64) -> Option<&mut [[u8; 4]]> {
        let start = index(row - self.first_row) * self.width;
        self.pixels
            .get_mut(start + index(left)..start + index(right))
    }

    /// Fills the part of `place` within the strip.
    pub(crate) fn clear(&mut self, place: Scissor, colour: [u8; 4]) {
        if let Some(place) = place.within(self.bounds()) {
            for row in place.top..place.bottom {
                if let Some(span) = self.span(row, place.left, place.right) {
                    span.fill(colour);
                }
            }
        }
    }

    /// The strip's rows as a scissor as wide as the picture.
    pub(crate) fn bounds(&self) -> Scissor {
        let rows = self.pixels.len() / self.width.max(1);
        Scissor {
            left: 0,
            top: self.first_row,
            right: coordinate(self.width),
            bottom: self.first_row + coordinate(rows),
        }
    }
}

/// A corner in 1/256 px.
#[derive(Debug, Clone, Copy)]
struct SubpixelPoint {
    x: i64,
    y: i64,
}

/// `a * x + b * y + c >= 0` is inside, ties settled by the top-left rule.
#[derive(Debug, Clone, Copy)]
struct Edge {
    a: i64,
    b: i64,
    c: i64,
}

impl Edge {
    fn new(from: SubpixelPoint, to: SubpixelPoint) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        Self {
            a: -dy,
            b: dx,
            c: dy * from.x - dx * from.y - i64::from(!top_left),
        }
    }

    /// Narrows `left..right` to the pixels whose centres are inside on row `row`.
    fn narrow_span(&self, row: i64, left: &mut i64, right: &mut i64) {
        let at_zero = self.b * (row * SUBPIXELS + HALF_PIXEL) + self.c + self.a * HALF_PIXEL;
        let step = self.a * SUBPIXELS;
        if step > 0 {
            *left = (*left).max((step - 1 - at_zero).div_euclid(step));
        } else if step < 0 {
            *right = (*right).min(at_zero.div_euclid(-step) + 1);
        } else if at_zero < 0 {
            *right = *left;
        }
    }
}

/// The plane through `N` values at the three corners.
#[derive(Debug, Clone, Copy)]
struct Plane<const N: usize> {
    origin: [f64; N],
    per_column: [f64; N],
    per_row: [f64; N],
}

impl<const N: usize> Plane<N> {
    fn new(corners: [SubpixelPoint; 3], area: i64, values: [[f32; N]; 3]) -> Self {
        let [p0, p1, p2] = corners;
        let [v0, v1, v2] = values.map(|corner| corner.map(f64::from));
        let unit = real(SUBPIXELS) / real(area);
        let (x1, y1) = (real(p1.x - p0.x), real(p1.y - p0.y));
        let (x2, y2) = (real(p2.x - p0.x), real(p2.y - p0.y));
        let mut plane = Self {
            origin: v0,
            per_column: [0.0; N],
            per_row: [0.0; N],
        };
        let slopes = plane.per_column.iter_mut().zip(&mut plane.per_row);
        for (((column, row), v0), (v1, v2)) in slopes.zip(v0).zip(v1.into_iter().zip(v2)) {
            *column = ((v1 - v0) * y2 - (v2 - v0) * y1) * unit;
            *row = ((v2 - v0) * x1 - (v1 - v0) * x2) * unit;
        }
        plane
    }

    /// The value at the centre of a pixel at an offset of `column`, `row` pixels from the first corner.
    fn at(&self, column: f64, row: f64) -> [f32; N] {
        let mut values = [0.0; N];
        let slopes = self.per_column.iter().zip(&self.per_row);
        for ((value, origin), (x, y)) in values.iter_mut().zip(self.origin).zip(slopes) {
            *value = narrow(origin + x * column + y * row);
        }
        values
    }

    fn steps(&self) -> [f32; N] {
        self.per_column.map(narrow)
    }
}

/// Source of a triangle's colours.
#[derive(Debug, Clone, Copy)]
enum Fill {
    /// One opaque colour.
    Opaque([u8; 4]),
    /// One colour, channels 0..=255.
    Flat([f32; 4]),
    /// A gradient times one texel (0..=1).
    Shaded(Plane<4>, [f32; 4]),
    /// One colour (0..=1) times a texture.
    Textured([f32; 4], Plane<2>),
    /// A gradient times a texture; red, green, blue, alpha.
    Both(Plane<4>, Plane<2>),
}

/// A triangle that touches pixels. Set up once, painted wherever the picture changes.
#[derive(Debug)]
pub(crate) struct Triangle {
    corners: [SubpixelPoint; 3],
    vertices: [Vertex; 3],
    area: i64,
    /// The pixels it may touch.
    pub(crate) bounds: Scissor,
}

impl Triangle {
    /// `None` if it has no area or a NaN corner, or if it is outside the scissor.
    pub(crate) fn new(vertices: [(Vertex, [f32; 2]); 3], scissor: Scissor) -> Option<Self> {
        let (corners, vertices, area) = wound(vertices)?;
        let bounds = bounds(corners, scissor)?;
        Some(Self {
            corners,
            vertices,
            area,
            bounds,
        })
    }

    /// A practically unique hash.
    pub(crate) fn fingerprint(&self, mut hasher: impl Hasher) -> u64 {
        let Scissor {
            left,
            top,
            right,
            bottom,
        } = self.bounds;
        hasher.write_u64(pair(left, top));
        hasher.write_u64(pair(right, bottom));
        for (corner, vertex) in self.corners.iter().zip(&self.vertices) {
            let [u, v] = [vertex.uv.x, vertex.uv.y].map(|at| u64::from(at.to_bits()));
            hasher.write_u64(pair(corner.x, corner.y));
            hasher.write_u64(u << 32 | v);
            hasher.write_u32(u32::from_le_bytes(vertex.color.to_array()));
        }
        hasher.finish()
    }

    /// Paints the triangle within the strip and the scissors, which are sorted by row from the top. A pixel's colour does not
    /// depend on the painted part.
    pub(crate) fn paint(&self, strip: &mut Strip<'_>, texture: &Texture, scissors: &[Scissor]) {
        let above = scissors.partition_point(|scissor| scissor.bottom <= self.bounds.top);
        let beside = scissors.iter().skip(above);
        let beside = beside.take_while(|scissor| scissor.top < self.bounds.bottom);
        let here = |scissor: &Scissor| self.bounds.within(*scissor);
        let mut places = beside.filter_map(here).peekable();
        if places.peek().is_none() {
            return;
        }
        let fill = fill(self.corners, self.area, self.vertices, texture);
        if matches!(fill, Fill::Flat([0.0, 0.0, 0.0, 0.0])) {
            return;
        }
        let [p0, p1, p2] = self.corners;
        let edges = [Edge::new(p0, p1), Edge::new(p1, p2), Edge::new(p2, p0)];
        for place in places {
            for row in place.top..place.bottom {
                // Start of the whole row: colours are counted from there.
                let (begin, end) = span(&edges, row, self.bounds);
                let (left, right) = (begin.max(place.left), end.min(place.right));
                if left < right
                    && let Some(span) = strip.span(row, left, right)
                {
                    let column = real(begin * SUBPIXELS + HALF_PIXEL - p0.x) / real(SUBPIXELS);
                    let line = real(row * SUBPIXELS + HALF_PIXEL - p0.y) / real(SUBPIXELS);
                    let skipped = texels(index(left - begin));
                    paint_span(span, &fill, texture, ([column, line], skipped));
                }
            }
        }
    }
}

/// Two screen coordinates, well within 32 bits, packed into one number.
const fn pair(x: i64, y: i64) -> u64 {
    x.cast_unsigned() << 32 | y.cast_unsigned() & 0xFFFF_FFFF
}

/// The pixels of a row, inside the bounds, whose centres are inside all edges.
fn span(edges: &[Edge; 3], row: i64, bounds: Scissor) -> (i64, i64) {
    let (mut left, mut right) = (bounds.left, bounds.right);
    for edge in edges {
        edge.narrow_span(row, &mut left, &mut right);
    }
    (left, right)
}

/// The corners clockwise on screen, with twice the area; egui uses both windings.
fn wound(vertices: [(Vertex, [f32; 2]); 3]) -> Option<([SubpixelPoint; 3], [Vertex; 3], i64)> {
    let [(v0, at0), (v1, at1), (v2, at2)] = vertices;
    let corner = |[x, y]: [f32; 2]| {
        Some(SubpixelPoint {
            x: fixed(x)?,
            y: fixed(y)?,
        })
    };
    let (p0, p1, p2) = (corner(at0)?, corner(at1)?, corner(at2)?);
    let area = (p1.x - p0.x) * (p2.y - p0.y) - (p2.x - p0.x) * (p1.y - p0.y);
    match area {
        0 => None,
        1.. => Some(([p0, p1, p2], [v0, v1, v2], area)),
        _ => Some(([p0, p2, p1], [v0, v2, v1], -area)),
    }
}

/// The pixels a triangle can touch; `None` if there are none.
fn bounds(corners: [SubpixelPoint; 3], scissor: Scissor) -> Option<Scissor> {
    let [p0, p1, p2] = corners;
    let first = |a: i64, b: i64, c: i64| a.min(b).min(c).div_euclid(SUBPIXELS);
    let last = |a: i64, b: i64, c: i64| a.max(b).max(c).div_euclid(SUBPIXELS) + 1;
    let touched = Scissor {
        left: first(p0.x, p1.x, p2.x),
        top: first(p0.y, p1.y, p2.y),
        right: last(p0.x, p1.x, p2.x),
        bottom: last(p0.y, p1.y, p2.y),
    };
    touched.within(scissor)
}

fn fill(corners: [SubpixelPoint; 3], area: i64, vertices: [Vertex; 3], texture: &Texture) -> Fill {
    let [v0, v1, v2] = vertices;
    let [width, height] = texture.scale();
    let colour = |vertex: Vertex| rgba(vertex.color);
    let texel = |vertex: Vertex| [vertex.uv.x * width, vertex.uv.y * height];
    let one_colour = v0.color == v1.color && v0.color == v2.color;
    let one_texel = v0.uv == v1.uv && v0.uv == v2.uv;
    let gradient = || Plane::new(corners, area, vertices.map(colour));
    let uv = || Plane::new(corners, area, vertices.map(texel));
    match (one_colour, one_texel) {
        (true, true) => {
            let [x, y] = texel(v0);
            flat(product(colour(v0), texture.sample(x, y).map(unit)))
        }
        (true, false) => Fill::Textured(colour(v0).map(unit), uv()),
        (false, true) => {
            let [x, y] = texel(v0);
            Fill::Shaded(gradient(), texture.sample(x, y).map(unit))
        }
        (false, false) => Fill::Both(gradient(), uv()),
    }
}

fn flat(colour: [f32; 4]) -> Fill {
    let [.., alpha] = colour;
    if alpha >= 255.0 {
        Fill::Opaque(colour.map(channel))
    } else {
        Fill::Flat(colour)
    }
}

/// Paints a span after skipping `skipped` columns of its row.
fn paint_span(
    span: &mut [[u8; 4]],
    fill: &Fill,
    texture: &Texture,
    ([column, row], skipped): ([f64; 2], f32),
) {
    match *fill {
        Fill::Opaque(colour) => span.fill(colour),
        Fill::Flat(colour) => span.iter_mut().for_each(|pixel| over(pixel, colour)),
        Fill::Shaded(gradient, texel) => {
            let colours = walk(gradient.at(column, row), gradient.steps(), skipped);
            for (pixel, colour) in span.iter_mut().zip(colours) {
                over(pixel, product(colour, texel));
            }
        }
        Fill::Textured(colour, uv) => {
            let places = walk(uv.at(column, row), uv.steps(), skipped);
            for (pixel, [x, y]) in span.iter_mut().zip(places) {
                over(pixel, product(texture.sample(x, y), colour));
            }
        }
        Fill::Both(gradient, uv) => {
            let colours = walk(gradient.at(column, row), gradient.steps(), skipped);
            let places = walk(uv.at(column, row), uv.steps(), skipped);
            for ((pixel, colour), [x, y]) in span.iter_mut().zip(colours).zip(places) {
                over(pixel, product(colour, texture.sample(x, y).map(unit)));
            }
        }
    }
}

/// The values of a plane along a row. Each is computed from the start, so that errors do not accumulate along a wide span.
fn walk<const N: usize>(
    start: [f32; N],
    step: [f32; N],
    mut column: f32,
) -> impl Iterator<Item = [f32; N]> {
    std::iter::repeat_with(move || {
        let mut values = start;
        for (value, step) in values.iter_mut().zip(step) {
            *value += step * column;
        }
        column += 1.0;
        values
    })
}

fn rgba(colour: Color32) -> [f32; 4] {
    colour.to_array().map(f32::from)
}

fn unit(channel: f32) -> f32 {
    channel / 255.0
}

fn product(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    let [a0, a1, a2, a3] = a;
    let [b0, b1, b2, b3] = b;
    [a0 * b0, a1 * b1, a2 * b2, a3 * b3]
}

/// Premultiplied source over destination, in gamma space, rounded after each blend like an 8-bit target.
fn over(pixel: &mut [u8; 4], colour: [f32; 4]) {
    let [.., alpha] = colour;
    let keep = 1.0 - alpha / 255.0;
    for (old, new) in pixel.iter_mut().zip(colour) {
        *old = channel(new + f32::from(*old) * keep);
    }
}
