//! Quantities with common times, and their conversion to lines. Independent of the hand.

use crate::history::column::{Column, Extremes};
use crate::history::grid::{Cell, Grid, GridKey};
use crate::history::reading::{Reading, Summary};
use crate::history::ring::RowRing;
use crate::history::trace::Trace;
use std::ops::Range;

/// Maximum number of rows of a pixel column that are read one by one around gaps; a wider one with gaps is drawn between two
/// breaks.
const GAP_ROWS_MAX: usize = 1024;
/// Columns begin at blocks of the pyramid of which this many fit into one column: a column then reads a handful of blocks,
/// however wide it is, and begins less than half a pixel early.
const STRETCHES_A_COLUMN: usize = 2;
/// Length ratio of adjacent levels of the pyramid.
const STRETCH_FACTOR: usize = 8;

/// Drawn time range and its number of pixel columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slice {
    /// Start, in seconds.
    pub(crate) from_s: f64,
    /// End, in seconds.
    pub(crate) to_s: f64,
    /// Number of pixel columns, at least 1.
    pub(crate) columns: u32,
}

/// A grid column by number, with the first rows of the previous column and of this one.
#[derive(Debug, Clone, Copy)]
struct Walk {
    number: i64,
    before: usize,
    here: usize,
}

/// Quantities that are read together.
#[derive(Debug, Clone)]
pub(crate) struct HistoryTrack {
    number: usize,
    times: RowRing<f64>,
    columns: Vec<Column>,
    gap_after_s: f64,
}

impl HistoryTrack {
    /// Creates a track; a silence longer than `gap_after_s` breaks its lines. `number` identifies the track.
    pub(crate) fn new(number: usize, quantities: usize, rows: usize, gap_after_s: f64) -> Self {
        Self {
            number,
            times: RowRing::new(rows),
            columns: (0..quantities).map(|_| Column::new(rows)).collect(),
            gap_after_s,
        }
    }

    /// Adds one row; missing values are unknown. An earlier time is raised to that of the last row.
    pub(crate) fn push(&mut self, at_s: f64, values: impl IntoIterator<Item = Option<f32>>) {
        if let Some(last) = self
            .times
            .last()
            .filter(|last| at_s - last > self.gap_after_s)
        {
            self.add(last, std::iter::empty());
        }
        self.add(at_s, values);
    }

    /// Breaks the lines at `at_s`.
    pub(crate) fn gap(&mut self, at_s: f64) {
        if self.times.end() > 0 {
            self.add(at_s, std::iter::empty());
        }
    }

    fn add(&mut self, at_s: f64, values: impl IntoIterator<Item = Option<f32>>) {
        let at_s = self.times.last().map_or(at_s, |last| at_s.max(last));
        self.times.push(at_s);
        let mut values = values.into_iter();
        for column in &mut self.columns {
            column.push(values.next().flatten().unwrap_or(f32::NAN));
        }
    }

    /// Time of the oldest row.
    pub(crate) fn first_s(&self) -> Option<f64> {
        self.times.get(self.times.start())
    }

    /// Time of the newest row.
    #[cfg(test)]
    pub(crate) fn last_s(&self) -> Option<f64> {
        self.times.last()
    }

    /// Memory held, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.times.bytes() + self.columns.iter().map(Column::bytes).sum::<usize>()
    }

    /// Fills `out` with the lines of one quantity.
    pub(crate) fn trace(&self, quantity: usize, slice: Slice, out: &mut Trace) {
        out.begin();
        let Some(column) = self.columns.get(quantity) else {
            return;
        };
        // One row beyond each edge, so that lines reach the border of the plot.
        let rows = self
            .row_at(slice.from_s, self.whole())
            .saturating_sub(1)
            .max(self.times.start())
            ..(self.row_at(slice.to_s, self.whole()) + 1).min(self.times.end());
        let most = usize::try_from(slice.columns)
            .unwrap_or(usize::MAX)
            .saturating_mul(2);
        if rows.len() <= most {
            self.each_row(column, rows, out);
        } else {
            self.each_column(quantity, rows, slice, out);
        }
        out.end();
    }

    /// The row nearest to a time between two known ones, or the newest row until the gap limit; `None` in a gap.
    pub(crate) fn reading(&self, quantity: usize, at_s: f64) -> Option<Reading> {
        let column = self.columns.get(quantity)?;
        let known = |row: usize| {
            let time_s = self.times.get(row)?;
            let value = column.get(row).filter(|value| !value.is_nan())?;
            Some(Reading { time_s, value })
        };
        let next = self.row_at(at_s, self.whole());
        if let Some(exact) = known(next).filter(|next| next.time_s <= at_s) {
            return Some(exact);
        }
        let before = known(next.checked_sub(1)?)?;
        let Some(next) = self.times.get(next).map(|_| known(next)) else {
            return Some(before).filter(|before| at_s - before.time_s <= self.gap_after_s);
        };
        let next = next?;
        let is_nearer = at_s - before.time_s <= next.time_s - at_s;
        Some(if is_nearer { before } else { next })
    }

    /// Summary of the known values in a time range, both ends included.
    pub(crate) fn summary(&self, quantity: usize, from_s: f64, to_s: f64) -> Option<Summary> {
        let column = self.columns.get(quantity)?;
        let rows = self.rows_within(from_s, to_s);
        let (extremes, sum) = (column.extremes(rows.clone()), column.sum(rows));
        (sum.count > 0).then(|| Summary {
            count: sum.count,
            min: extremes.min,
            max: extremes.max,
            mean: sum.sum / f64::from(sum.count),
        })
    }

    /// Rows in a time range, both ends included.
    pub(crate) fn rows_within(&self, from_s: f64, to_s: f64) -> Range<usize> {
        let from = self.row_at(from_s, self.whole());
        from..self.row_at(to_s.next_up(), self.whole()).max(from)
    }

    pub(crate) fn time_s(&self, row: usize) -> Option<f64> {
        self.times.get(row)
    }

    /// One value; `None` if it is no longer held, NaN if it is unknown.
    pub(crate) fn value(&self, quantity: usize, row: usize) -> Option<f32> {
        self.columns.get(quantity)?.get(row)
    }

    /// Copies the rows of a time range, into just enough memory.
    pub(crate) fn slice(&self, from_s: f64, to_s: f64) -> Self {
        let rows = self.rows_within(from_s, to_s);
        let mut copy = Self::new(
            self.number,
            self.columns.len(),
            rows.len(),
            self.gap_after_s,
        );
        for row in rows {
            if let Some(at_s) = self.times.get(row) {
                copy.add(at_s, self.columns.iter().map(|column| column.get(row)));
            }
        }
        copy
    }

    fn whole(&self) -> Range<usize> {
        self.times.start()..self.times.end()
    }

    /// The first row at or after a time, within these rows.
    fn row_at(&self, at_s: f64, within: Range<usize>) -> usize {
        let (mut low, mut high) = (within.start, within.end);
        while low < high {
            let middle = low.midpoint(high);
            if self.times.get(middle).is_some_and(|time| time < at_s) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }

    fn each_row(&self, column: &Column, rows: Range<usize>, out: &mut Trace) {
        for row in rows {
            match (self.times.get(row), column.get(row)) {
                (Some(time), Some(value)) if !value.is_nan() => out.point(time, value),
                _ => out.end(),
            }
        }
    }

    /// Columns lie on a fixed time grid, so that a scrolling line does not flicker and past columns never change.
    fn each_column(&self, quantity: usize, rows: Range<usize>, slice: Slice, out: &mut Trace) {
        let Some(column) = self.columns.get(quantity) else {
            return;
        };
        out.decimated = true;
        let key = GridKey {
            track: self.number,
            quantity,
            step_ns: step_ns(slice),
        };
        let mut grid = std::mem::take(&mut out.grid);
        let first = self.first_number(key.step_s(), rows.start);
        grid.ready(key, first, |cell| {
            self.times.get(cell.start) == Some(cell.first_s)
                && column.get(cell.start).map(f32::to_bits) == cell.first_bits
        });
        self.fill(column, key.step_s(), rows.end, &mut grid);
        for point in grid.points_before(rows.end) {
            if point.value.is_nan() {
                out.end();
            } else {
                out.point(point.time_s, point.value);
            }
        }
        out.grid = grid;
    }

    /// Number of a row's column, or of the next one whose rows are certainly all held.
    fn first_number(&self, step_s: f64, row: usize) -> i64 {
        let oldest = self.times.start();
        let number = self.time_s(row).map_or(0, |at_s| number_at(at_s, step_s));
        let whole = self.time_s(oldest).filter(|_| oldest > 0);
        // A column's rows depend on those of the one before it.
        whole.map_or(number, |at_s| number.max(number_at(at_s, step_s) + 3))
    }

    /// Adds the columns up to a row.
    fn fill(&self, column: &Column, step_s: f64, end: usize, grid: &mut Grid) {
        let mut walk = self.walk_at(grid.next(), step_s);
        let mut start = self.border(walk);
        while start < end {
            let next = self.walk_on(walk, step_s);
            let finished = next.here < self.times.end();
            let after = self.border(next);
            if after > start {
                let held = grid.len();
                self.one_column(column, start..after, grid);
                grid.close(Cell {
                    number: walk.number,
                    start,
                    first_s: self.time_s(start).unwrap_or_default(),
                    first_bits: column.get(start).map(f32::to_bits),
                    finished,
                    points: grid.len() - held,
                });
                (walk, start) = (next, after);
            } else {
                // Nothing was measured in this column: go to the one of the next row.
                let ahead = self.time_s(start).map_or(0, |at_s| number_at(at_s, step_s));
                walk = self.walk_at(next.number.max(ahead - 1), step_s);
                grid.skip_to(walk.number);
            }
        }
    }

    fn walk_at(&self, number: i64, step_s: f64) -> Walk {
        let row = |number| self.row_at(begin_s(number, step_s), self.whole());
        Walk {
            number,
            before: row(number - 1),
            here: row(number),
        }
    }

    /// Steps to the next column.
    fn walk_on(&self, walk: Walk, step_s: f64) -> Walk {
        let number = walk.number + 1;
        let (from_s, end) = (begin_s(number, step_s), self.times.end());
        // It is probably as wide as the last one: searches nearby first.
        let near = (walk.here + 2 * (walk.here - walk.before) + 2).min(end);
        let here = match self.row_at(from_s, walk.here..near) {
            row if row < near => row,
            _ => self.row_at(from_s, near..end),
        };
        Walk {
            number,
            before: walk.here,
            here,
        }
    }

    /// First row of a column, aligned to a block of the pyramid.
    const fn border(&self, walk: Walk) -> usize {
        if walk.here == self.times.end() {
            return walk.here;
        }
        walk.here - walk.here % whole_rows(walk.here - walk.before)
    }

    fn one_column(&self, column: &Column, rows: Range<usize>, grid: &mut Grid) {
        let extremes = column.extremes(rows.clone());
        if !extremes.gap {
            self.pair(column, rows, extremes, grid);
        } else if rows.len() > GAP_ROWS_MAX {
            self.interrupt(rows.start, grid);
            self.pair(column, rows.clone(), extremes, grid);
            self.interrupt(rows.start, grid);
        } else {
            self.runs(column, rows, grid);
        }
    }

    /// Draws each unbroken run of rows between gaps by its own extremes.
    fn runs(&self, column: &Column, rows: Range<usize>, grid: &mut Grid) {
        let mut begin = rows.start;
        let is_gap = |row: &usize| column.get(*row).is_none_or(f32::is_nan);
        for gap in rows.clone().filter(is_gap).chain([rows.end]) {
            let run = begin..gap;
            self.pair(column, run.clone(), column.extremes(run), grid);
            if gap < rows.end {
                self.interrupt(gap, grid);
            }
            begin = gap + 1;
        }
    }

    /// Adds the minimum and maximum of some rows, in the order that follows the line.
    fn pair(&self, column: &Column, rows: Range<usize>, extremes: Extremes, grid: &mut Grid) {
        let Some(last) = rows.end.checked_sub(1).filter(|_| !extremes.is_empty()) else {
            return;
        };
        let rises = column.get(rows.start) <= column.get(last);
        let (one, two) = if rises {
            (extremes.min, extremes.max)
        } else {
            (extremes.max, extremes.min)
        };
        let middle = rows.start.midpoint(rows.end).min(last);
        grid.point(self.time_s(rows.start).unwrap_or_default(), one);
        if last > rows.start {
            grid.point(self.time_s(middle).unwrap_or_default(), two);
        }
    }

    /// Breaks the line at a row.
    fn interrupt(&self, row: usize, grid: &mut Grid) {
        grid.point(self.time_s(row).unwrap_or_default(), f32::NAN);
    }
}

/// Decimates a line to at most `most` points, with all extremes preserved, by the method of the plots. The points are ordered by
/// time.
pub fn decimated(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    let (Some([from_s, _]), Some([to_s, _])) = (points.first(), points.last()) else {
        return Vec::new();
    };
    if points.len() <= most {
        return points.to_vec();
    }
    let mut track = HistoryTrack::new(0, 1, points.len(), f64::INFINITY);
    for [at_s, value] in points {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "readings are short numbers"
        )]
        track.push(*at_s, [Some(*value as f32)]);
    }
    // The grid is not aligned with the line: it may need one more column at either end.
    let columns = u32::try_from(most / 2)
        .unwrap_or(u32::MAX)
        .saturating_sub(2);
    let slice = Slice {
        from_s: *from_s,
        to_s: *to_s,
        columns: columns.max(1),
    };
    let mut trace = Trace::default();
    track.trace(0, slice, &mut trace);
    trace.points().collect()
}

/// Width of a column, in whole nanoseconds.
#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to an hour just before"
)]
fn step_ns(slice: Slice) -> i64 {
    let step_s = (slice.to_s - slice.from_s) / f64::from(slice.columns.max(1));
    (step_s * 1e9).round().clamp(1.0, 3.6e12) as i64
}

/// Number of the column that contains a time.
#[expect(
    clippy::cast_possible_truncation,
    reason = "times are of one run of the program, and a float is cut to the ends of the whole numbers"
)]
fn number_at(at_s: f64, step_s: f64) -> i64 {
    (at_s / step_s).floor() as i64
}

/// Time at which a column begins, in seconds.
#[expect(
    clippy::cast_precision_loss,
    reason = "a day holds far fewer than 2^53 columns"
)]
fn begin_s(number: i64, step_s: f64) -> f64 {
    number as f64 * step_s
}

/// Rows of the longest block of the pyramid of which enough fit into a column of `width` rows.
const fn whole_rows(width: usize) -> usize {
    let mut rows = 1;
    while rows * STRETCH_FACTOR * STRETCHES_A_COLUMN <= width {
        rows *= STRETCH_FACTOR;
    }
    rows
}
