//! Quantities that are read together, over one row of times, and how they become lines. Knows no hand.

use crate::app::history::column::{Column, Extremes};
use crate::app::history::reading::{Reading, Summary};
use crate::app::history::ring::Ring;
use crate::app::history::trace::{Cut, CutKey, Stretch, Trace};
use std::ops::Range;

/// Rows that one trace may look at one by one around gaps; a stretch with more of them is drawn as a break.
const GAP_ROWS_MAX: usize = 4096;
/// Columns begin at a whole stretch of the pyramid of which this many fit in: a column then looks at a handful of
/// stretches, however many rows it is wide, and begins less than half a pixel too early.
const STRETCHES_A_COLUMN: usize = 2;
/// Each stretch of the pyramid is this many times as long as the next shorter one.
const STRETCH_FACTOR: usize = 8;

/// What is drawn: a stretch of time over some columns of pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slice {
    /// From here, in seconds.
    pub(crate) from_s: f64,
    /// To here.
    pub(crate) to_s: f64,
    /// Columns of pixels, at least 1.
    pub(crate) columns: u32,
}

/// Quantities that are read together.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    number: u8,
    times: Ring<f64>,
    columns: Vec<Column>,
    gap_after_s: f64,
}

impl Track {
    /// So many quantities and rows; a longer silence than `gap_after_s` breaks the lines. `number` tells tracks apart.
    pub(crate) fn new(number: u8, quantities: usize, rows: usize, gap_after_s: f64) -> Self {
        Self {
            number,
            times: Ring::new(rows),
            columns: (0..quantities).map(|_| Column::new(rows)).collect(),
            gap_after_s,
        }
    }

    /// Adds one row; missing values are not known. Time never runs back.
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

    /// Breaks the lines here.
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
    pub(crate) fn last_s(&self) -> Option<f64> {
        self.times.last()
    }

    /// Bytes held.
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
            self.each_column(column, rows, slice, out);
        }
        out.end();
    }

    /// The newest row at or before a time, or the next one if that is nearer; `None` in a gap.
    pub(crate) fn reading(&self, quantity: usize, at_s: f64) -> Option<Reading> {
        let column = self.columns.get(quantity)?;
        let next = self.row_at(at_s, self.whole());
        let near = |row: usize| {
            let time_s = self.times.get(row)?;
            let value = column.get(row).filter(|value| !value.is_nan())?;
            let apart_s = (time_s - at_s).abs();
            (apart_s <= self.gap_after_s).then_some((apart_s, Reading { time_s, value }))
        };
        let both = [next.checked_sub(1).and_then(near), near(next)];
        let nearest = both
            .into_iter()
            .flatten()
            .min_by(|one, two| one.0.total_cmp(&two.0));
        nearest.map(|(_, reading)| reading)
    }

    /// What the known values of a stretch of time come to; both ends belong to it.
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

    /// The rows of a stretch of time; both ends belong to it.
    pub(crate) fn rows_within(&self, from_s: f64, to_s: f64) -> Range<usize> {
        let from = self.row_at(from_s, self.whole());
        from..self.row_at(to_s.next_up(), self.whole()).max(from)
    }

    /// Time of a row.
    pub(crate) fn time_s(&self, row: usize) -> Option<f64> {
        self.times.get(row)
    }

    /// One value; `None` if it is not held, NaN if it is not known.
    pub(crate) fn value(&self, quantity: usize, row: usize) -> Option<f32> {
        self.columns.get(quantity)?.get(row)
    }

    /// A copy of the rows of a stretch of time, in as much memory as they need.
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

    /// The same, when it is probably about `step` rows ahead: looks near first.
    fn row_ahead(&self, at_s: f64, from: usize, step: usize, end: usize) -> usize {
        let (mut low, mut reach) = (from, step.max(1));
        loop {
            let probe = low.saturating_add(reach);
            if probe >= end {
                return self.row_at(at_s, low..end);
            }
            if self.times.get(probe).is_none_or(|time| time >= at_s) {
                return self.row_at(at_s, low..probe);
            }
            low = probe;
            reach = reach.saturating_mul(2);
        }
    }

    fn each_row(&self, column: &Column, rows: Range<usize>, out: &mut Trace) {
        for row in rows {
            match (self.times.get(row), column.get(row)) {
                (Some(time), Some(value)) if !value.is_nan() => out.point(time, value),
                _ => out.end(),
            }
        }
    }

    /// Columns stand on a grid of time that does not move with the window, so that a scrolling line does not flicker.
    fn each_column(&self, column: &Column, rows: Range<usize>, slice: Slice, out: &mut Trace) {
        out.decimated = true;
        let key = CutKey {
            track: self.number,
            end: self.times.end(),
            from_s: slice.from_s,
            to_s: slice.to_s,
            columns: slice.columns,
        };
        let mut cut = std::mem::take(&mut out.cut);
        if cut.key != Some(key) {
            self.cut(rows, slice, &mut cut);
            cut.key = Some(key);
        }
        let mut budget = GAP_ROWS_MAX;
        for stretch in &cut.stretches {
            self.one_column(column, *stretch, &mut budget, out);
        }
        out.cut = cut;
    }

    fn cut(&self, rows: Range<usize>, slice: Slice, cut: &mut Cut) {
        cut.stretches.clear();
        let step_s = (slice.to_s - slice.from_s) / f64::from(slice.columns.max(1));
        let column_after =
            |row: usize| (self.times.get(row).unwrap_or(slice.to_s) / step_s).floor() + 1.0;
        let mut border = column_after(rows.start);
        let (mut row, mut width) = (rows.start, 1);
        while row < rows.end {
            let mut next = self.row_ahead(border * step_s, row, width, rows.end);
            if next < rows.end {
                next -= next % whole_rows(next - row);
            }
            if next > row {
                cut.stretches.push(self.stretch(row..next, slice.to_s));
                width = next - row;
                row = next;
                border += 1.0;
            } else {
                // Nothing was measured in this column: go to the one of the next row.
                border = column_after(row);
            }
        }
    }

    fn stretch(&self, rows: Range<usize>, else_s: f64) -> Stretch {
        let time = |row| self.times.get(row).unwrap_or(else_s);
        Stretch {
            start: rows.start,
            end: rows.end,
            first_s: time(rows.start),
            middle_s: time(
                rows.start
                    .midpoint(rows.end)
                    .min(rows.end.saturating_sub(1)),
            ),
        }
    }

    fn one_column(&self, column: &Column, stretch: Stretch, budget: &mut usize, out: &mut Trace) {
        let rows = stretch.start..stretch.end;
        let extremes = column.extremes(rows.clone());
        if extremes.is_empty() {
            out.end();
        } else if !extremes.gap {
            pair(column, stretch, extremes, out);
        } else if let Some(rest) = budget.checked_sub(rows.len()) {
            *budget = rest;
            self.runs(column, rows, out);
        } else {
            // Too many gaps to look at each: both ends of the stretch are breaks.
            out.end();
            pair(column, stretch, extremes, out);
            out.end();
        }
    }

    /// The unbroken runs of rows between gaps, each by its own extremes.
    fn runs(&self, column: &Column, rows: Range<usize>, out: &mut Trace) {
        let mut begin = rows.start;
        for row in rows.clone() {
            if column.get(row).is_none_or(f32::is_nan) {
                self.run(column, begin..row, out);
                out.end();
                begin = row + 1;
            }
        }
        self.run(column, begin..rows.end, out);
    }

    fn run(&self, column: &Column, rows: Range<usize>, out: &mut Trace) {
        if let Some(first_s) = self.times.get(rows.start).filter(|_| !rows.is_empty()) {
            let extremes = column.extremes(rows.clone());
            pair(column, self.stretch(rows, first_s), extremes, out);
        }
    }
}

/// Rows of the longest stretch of the pyramid of which enough fit into a column of so many rows.
const fn whole_rows(width: usize) -> usize {
    let mut rows = 1;
    while rows * STRETCH_FACTOR * STRETCHES_A_COLUMN <= width {
        rows *= STRETCH_FACTOR;
    }
    rows
}

/// Smallest and largest value of a stretch, in the order that follows the line.
fn pair(column: &Column, stretch: Stretch, extremes: Extremes, out: &mut Trace) {
    let Some(last) = stretch.end.checked_sub(1).filter(|_| !extremes.is_empty()) else {
        return;
    };
    let (min, max) = (extremes.min, extremes.max);
    let rises = column.get(stretch.start) <= column.get(last);
    let (one, two) = if rises { (min, max) } else { (max, min) };
    out.point(stretch.first_s, one);
    if last > stretch.start {
        out.point(stretch.middle_s, two);
    }
}
