//! Quantities that are read together, over one row of times, and how they become lines. Knows no hand.

use crate::app::history::column::{Column, Extremes};
use crate::app::history::ring::Ring;
use crate::app::history::trace::Trace;
use std::ops::Range;

/// Rows that one trace may look at one by one around gaps; a stretch with more of them is drawn as a break.
const GAP_ROWS_MAX: usize = 4096;
/// Columns at least this many rows wide begin at a whole stretch: no row is then looked at by itself.
const WHOLE_FROM_ROWS: usize = 32;
/// Rows in the smallest stretch.
const STRETCH_ROWS: usize = 8;

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
    times: Ring<f64>,
    columns: Vec<Column>,
    gap_after_s: f64,
}

impl Track {
    /// So many quantities and rows; a longer silence than `gap_after_s` breaks the lines.
    pub(crate) fn new(quantities: usize, rows: usize, gap_after_s: f64) -> Self {
        Self {
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
        let step_s = (slice.to_s - slice.from_s) / f64::from(slice.columns.max(1));
        let mut border =
            (self.times.get(rows.start).unwrap_or(slice.from_s) / step_s).floor() + 1.0;
        let mut budget = GAP_ROWS_MAX;
        let (mut row, mut width) = (rows.start, 1);
        while row < rows.end {
            let mut next = self.row_ahead(border * step_s, row, width, rows.end);
            if next - row >= WHOLE_FROM_ROWS && next < rows.end {
                next -= next % STRETCH_ROWS;
            }
            if next > row {
                self.one_column(column, row..next, &mut budget, out);
                width = next - row;
                row = next;
                border += 1.0;
            } else {
                // Nothing was measured in this column: go to the one of the next row.
                border = (self.times.get(row).unwrap_or(slice.to_s) / step_s).floor() + 1.0;
            }
        }
    }

    fn one_column(&self, column: &Column, rows: Range<usize>, budget: &mut usize, out: &mut Trace) {
        let extremes = column.extremes(rows.clone());
        if extremes.is_empty() {
            out.end();
        } else if !extremes.gap {
            self.pair(column, rows, extremes, out);
        } else if let Some(rest) = budget.checked_sub(rows.len()) {
            *budget = rest;
            self.runs(column, rows, out);
        } else {
            // Too many gaps to look at each: both ends of the stretch are breaks.
            out.end();
            self.pair(column, rows, extremes, out);
            out.end();
        }
    }

    /// The unbroken runs of rows between gaps, each by its own extremes.
    fn runs(&self, column: &Column, rows: Range<usize>, out: &mut Trace) {
        let mut begin = rows.start;
        for row in rows.clone() {
            if column.get(row).is_none_or(f32::is_nan) {
                self.pair(column, begin..row, column.extremes(begin..row), out);
                out.end();
                begin = row + 1;
            }
        }
        self.pair(
            column,
            begin..rows.end,
            column.extremes(begin..rows.end),
            out,
        );
    }

    /// Smallest and largest value of a stretch, in the order that follows the line.
    fn pair(&self, column: &Column, rows: Range<usize>, extremes: Extremes, out: &mut Trace) {
        let (Some(last), false) = (rows.end.checked_sub(1), extremes.is_empty()) else {
            return;
        };
        let middle = rows.start.midpoint(rows.end);
        let (Some(first_s), Some(middle_s)) =
            (self.times.get(rows.start), self.times.get(middle.min(last)))
        else {
            return;
        };
        let (min, max) = (extremes.min, extremes.max);
        let rises = column.get(rows.start) <= column.get(last);
        let (one, two) = if rises { (min, max) } else { (max, min) };
        out.point(first_s, one);
        if rows.len() > 1 {
            out.point(middle_s, two);
        }
    }
}
