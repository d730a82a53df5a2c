//! Pixel columns of one line, cached between frames: past columns never change. Holds no rows; the track fills it.

use std::collections::VecDeque;

/// Identity of a cached grid. Columns with another key are discarded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct GridKey {
    /// Number of the track.
    pub(crate) track: usize,
    /// Index of the quantity within the track.
    pub(crate) quantity: usize,
    /// Width of a column, in whole nanoseconds, so that rounding does not shift the grid while the window moves.
    pub(crate) step_ns: i64,
}

impl GridKey {
    #[expect(
        clippy::cast_precision_loss,
        reason = "a column is far shorter than 2^53 ns"
    )]
    pub(crate) fn step_s(self) -> f64 {
        self.step_ns as f64 * 1e-9
    }
}

/// One non-empty column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cell {
    /// Column number: it begins at `number` times the step.
    pub(crate) number: i64,
    /// First row.
    pub(crate) start: usize,
    /// Time of the first row.
    pub(crate) first_s: f64,
    /// Bits of the first value: distinguish two histories with the same times.
    pub(crate) first_bits: Option<u32>,
    /// False while more rows may arrive.
    pub(crate) finished: bool,
    /// Number of points in this column.
    pub(crate) points: usize,
}

/// A point of a line; one without a value breaks the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GridPoint {
    pub(crate) time_s: f64,
    /// NaN breaks the line.
    pub(crate) value: f32,
}

/// Contiguous columns; empty ones are omitted.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Grid {
    key: Option<GridKey>,
    /// Number of the first cached column.
    from: i64,
    /// Number of the column after the last finished one.
    next: i64,
    cells: VecDeque<Cell>,
    points: VecDeque<GridPoint>,
}

impl Grid {
    /// Prepares for filling from column [`Self::next`] on: drops columns before `first`, and all columns if `holds` rejects the
    /// first or last one, or if a hole would remain.
    pub(crate) fn ready(&mut self, key: GridKey, first: i64, holds: impl Fn(&Cell) -> bool) {
        self.drop_open();
        if self.key == Some(key) && (self.from..=self.next).contains(&first) {
            self.drop_before(first);
            if self.cells.front().is_none_or(&holds) && self.cells.back().is_none_or(&holds) {
                return;
            }
        }
        self.cells.clear();
        self.points.clear();
        (self.key, self.from, self.next) = (Some(key), first, first);
    }

    /// Number of the first column that still has to be filled.
    pub(crate) const fn next(&self) -> i64 {
        self.next
    }

    /// Adds a column with the points added since the previous one.
    pub(crate) fn close(&mut self, cell: Cell) {
        if cell.finished {
            self.next = cell.number + 1;
        }
        self.cells.push_back(cell);
    }

    /// Marks all columns before `number` as empty.
    pub(crate) fn skip_to(&mut self, number: i64) {
        self.next = self.next.max(number);
    }

    pub(crate) fn point(&mut self, time_s: f64, value: f32) {
        self.points.push_back(GridPoint { time_s, value });
    }

    /// Number of cached points.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// Points of the columns that begin before a row.
    pub(crate) fn points_before(&self, row: usize) -> impl Iterator<Item = GridPoint> {
        let beyond = self.cells.iter().rev().take_while(|cell| cell.start >= row);
        let beyond: usize = beyond.map(|cell| cell.points).sum();
        self.points
            .iter()
            .take(self.points.len().saturating_sub(beyond))
            .copied()
    }

    fn drop_open(&mut self) {
        while let Some(open) = self.cells.pop_back_if(|cell| !cell.finished) {
            self.points
                .truncate(self.points.len().saturating_sub(open.points));
        }
    }

    fn drop_before(&mut self, first: i64) {
        while let Some(past) = self.cells.pop_front_if(|cell| cell.number < first) {
            self.points.drain(..past.points.min(self.points.len()));
        }
        self.from = first;
    }
}
