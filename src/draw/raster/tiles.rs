//! Detects the parts of a picture that differ from the previous one, by a fingerprint of all triangles on each tile. Draws
//! nothing.

use crate::raster::number::{coordinate, index};
use crate::raster::triangle::Scissor;
use std::ops::Range;

/// Side of a tile in pixels.
pub(crate) const TILE: usize = 32;

/// Spreads a fingerprint over 64 bits: an odd number with random-looking bits (2^64 over the golden ratio).
const SPREAD: u64 = 0x9E37_79B9_7F4A_7C15;

/// Fingerprints of the tiles as last drawn, row by row; 0 means never drawn.
#[derive(Debug, Default)]
pub(crate) struct Tiles {
    columns: usize,
    drawn: Vec<u64>,
}

/// Tiles of adjacent rows, owned by one thread.
#[derive(Debug)]
pub(crate) struct TileRows<'a> {
    first_row: i64,
    columns: usize,
    drawn: &'a mut [u64],
    next: Vec<u64>,
}

impl Tiles {
    /// Fits a picture of this many pixels. A different size invalidates all tiles.
    pub(crate) fn resize(&mut self, width: usize, height: usize) {
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        if self.columns != columns || self.drawn.len() != columns * rows {
            self.columns = columns;
            self.drawn = vec![0; columns * rows];
        }
    }

    /// Invalidates all tiles.
    pub(crate) fn forget(&mut self) {
        self.drawn.fill(0);
    }

    /// Splits the tiles into strips of `rows` rows each, with a fingerprint that begins with `background`.
    pub(crate) fn strips(
        &mut self,
        rows: usize,
        background: u64,
    ) -> impl Iterator<Item = TileRows<'_>> {
        let columns = self.columns;
        let strips = self.drawn.chunks_mut((columns * rows).max(1));
        strips.enumerate().map(move |(number, drawn)| TileRows {
            first_row: coordinate(number * rows),
            columns,
            next: vec![background.wrapping_mul(SPREAD) | 1; drawn.len()],
            drawn,
        })
    }
}

impl TileRows<'_> {
    /// Adds a fingerprint to the tiles under these pixels, on top of all earlier ones.
    pub(crate) fn note(&mut self, pixels: Scissor, fingerprint: u64) {
        let columns = tiles(pixels.left, pixels.right);
        for row in self.rows(pixels) {
            let row = row * self.columns;
            let tiles = self.next.get_mut(row + columns.start..row + columns.end);
            for tile in tiles.into_iter().flatten() {
                *tile = (tile.rotate_left(23) ^ fingerprint).wrapping_mul(SPREAD);
            }
        }
    }

    /// Changed areas, as runs of adjacent tiles.
    pub(crate) fn changes(&mut self) -> Vec<Scissor> {
        let mut changes: Vec<Scissor> = Vec::new();
        for (at, (drawn, next)) in self.drawn.iter_mut().zip(&self.next).enumerate() {
            if std::mem::replace(drawn, *next) == *next {
                continue;
            }
            let left = coordinate(at % self.columns * TILE);
            let top = (self.first_row + coordinate(at / self.columns)) * coordinate(TILE);
            let tile = Scissor {
                left,
                top,
                right: left + coordinate(TILE),
                bottom: top + coordinate(TILE),
            };
            match changes.last_mut() {
                Some(run) if run.right == left && run.top == top => run.right = tile.right,
                _ => changes.push(tile),
            }
        }
        changes
    }

    fn rows(&self, pixels: Scissor) -> Range<usize> {
        let above = self.first_row * coordinate(TILE);
        tiles(pixels.top - above, pixels.bottom - above)
    }
}

/// The tiles that contain these pixels.
fn tiles(from: i64, to: i64) -> Range<usize> {
    index(from) / TILE..index(to).div_ceil(TILE)
}
