//! The columns of pixels of one line, kept from one drawing to the next: a column that is past never changes. Knows
//! neither rows of times nor values: whoever fills it does.

use std::collections::VecDeque;

/// What a grid is of. Columns of another key are of no use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct GridKey {
    /// Which row of times.
    pub(crate) track: usize,
    /// Which line of it.
    pub(crate) quantity: usize,
    /// Width of a column; whole, so that the grid does not creep with the rounding of a moving window.
    pub(crate) step_ns: i64,
}

impl GridKey {
    /// Width of a column, in seconds.
    #[expect(
        clippy::cast_precision_loss,
        reason = "a column is far shorter than 2^53 ns"
    )]
    pub(crate) fn step_s(self) -> f64 {
        self.step_ns as f64 * 1e-9
    }
}

/// One column that holds something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cell {
    /// Its number: it begins at so many steps.
    pub(crate) number: i64,
    /// First row.
    pub(crate) start: usize,
    /// Time of the first row.
    pub(crate) first_s: f64,
    /// Bits of the first value: tells two histories apart that have the same times.
    pub(crate) first_bits: Option<u32>,
    /// False while rows may still come.
    pub(crate) finished: bool,
    /// Points of this column.
    pub(crate) points: usize,
}

/// A point of a line; one without a value breaks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GridPoint {
    /// In seconds.
    pub(crate) time_s: f64,
    /// NaN is a break.
    pub(crate) value: f32,
}

/// Columns without holes between them; empty ones are left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Grid {
    key: Option<GridKey>,
    /// Number of the column from which on all are here.
    from: i64,
    /// Number of the column after the last one that is finished.
    next: i64,
    cells: VecDeque<Cell>,
    points: VecDeque<GridPoint>,
}

impl Grid {
    /// Makes it ready to be filled from the column [`Self::next`] on: columns before `first` go, and all of them where
    /// `holds` denies one of the outer ones or they would leave a hole.
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

    /// Number of the first column that is still to be filled.
    pub(crate) const fn next(&self) -> i64 {
        self.next
    }

    /// Adds a column with the points that were added since the last one.
    pub(crate) fn close(&mut self, cell: Cell) {
        if cell.finished {
            self.next = cell.number + 1;
        }
        self.cells.push_back(cell);
    }

    /// Columns up to here are empty.
    pub(crate) fn skip_to(&mut self, number: i64) {
        self.next = self.next.max(number);
    }

    /// Adds a point.
    pub(crate) fn point(&mut self, time_s: f64, value: f32) {
        self.points.push_back(GridPoint { time_s, value });
    }

    /// Points that are held.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// The points of the columns that begin before a row.
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
