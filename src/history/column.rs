//! One measured quantity with its minima and maxima over a hierarchy of ever longer blocks of rows. No times.

use crate::history::ring::RowRing;
use std::ops::Range;

/// Length ratio of adjacent levels, as a shift.
const FACTOR_SHIFT: u32 = 3;
/// Levels above the values: the topmost block spans 32 768 rows, a twentieth of the full history.
const LEVELS: u32 = 5;
/// The lowest level with sums: a mean reads at most 63 single values at either end.
const SUMS_FROM: u32 = 2;

/// The extremes of a range of rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extremes {
    /// Smallest known value; above `max` if no value is known.
    pub(crate) min: f32,
    /// Largest known value.
    pub(crate) max: f32,
    /// True if any value in the range is unknown.
    pub(crate) gap: bool,
}

impl Extremes {
    /// The extremes of an empty range.
    pub(crate) const NONE: Self = Self {
        min: f32::INFINITY,
        max: f32::NEG_INFINITY,
        gap: false,
    };

    fn of(value: f32) -> Self {
        let mut one = Self::NONE;
        one.push(value);
        one
    }

    /// Adds one value. NaN is a gap.
    pub(crate) fn push(&mut self, value: f32) {
        self.gap |= value.is_nan();
        self.min = self.min.min(value);
        self.max = self.max.max(value);
    }

    fn join(&mut self, other: Self) {
        self.gap |= other.gap;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// True if no value is known.
    pub(crate) fn is_empty(&self) -> bool {
        self.min > self.max
    }
}

/// Sum and number of the known values in a range.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ColumnSum {
    /// Sum of the known values.
    pub(crate) sum: f64,
    /// Number of known values.
    pub(crate) count: u32,
}

impl ColumnSum {
    fn push(&mut self, value: f32) {
        if !value.is_nan() {
            self.sum += f64::from(value);
            self.count += 1;
        }
    }

    fn join(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }
}

/// One measured quantity, newest rows only. NaN means unknown.
#[derive(Debug, Clone)]
pub(crate) struct Column {
    values: RowRing<f32>,
    levels: Vec<RowRing<Extremes>>,
    sums: Vec<RowRing<ColumnSum>>,
}

impl Column {
    /// Creates a column of at most `room` rows.
    pub(crate) fn new(room: usize) -> Self {
        let stretches = |level| (room >> (FACTOR_SHIFT * level)) + 2;
        Self {
            values: RowRing::new(room),
            levels: (1..=LEVELS)
                .map(|level| RowRing::new(stretches(level)))
                .collect(),
            sums: (SUMS_FROM..=LEVELS)
                .map(|level| RowRing::new(stretches(level)))
                .collect(),
        }
    }

    pub(crate) fn push(&mut self, value: f32) {
        let row = self.values.end();
        self.values.push(value);
        for (level, ring) in (1..).zip(&mut self.levels) {
            let starts = row.is_multiple_of(span(level));
            match ring.last_mut().filter(|_| !starts) {
                Some(newest) => newest.push(value),
                None => ring.push(Extremes::of(value)),
            }
        }
        for (level, ring) in (SUMS_FROM..).zip(&mut self.sums) {
            if row.is_multiple_of(span(level)) {
                ring.push(ColumnSum::default());
            }
            if let Some(newest) = ring.last_mut() {
                newest.push(value);
            }
        }
    }

    /// One row; `None` if it is no longer held, NaN if the value is unknown.
    pub(crate) fn get(&self, row: usize) -> Option<f32> {
        self.values.get(row)
    }

    /// Extremes of these rows; the work grows with the logarithm of their number.
    pub(crate) fn extremes(&self, rows: Range<usize>) -> Extremes {
        let mut all = Extremes::NONE;
        let mut row = rows.start;
        while row < rows.end {
            let level = self.level_at(row, rows.end);
            match self.stretch(level, row) {
                Some(stretch) => all.join(stretch),
                None => all.gap = true,
            }
            row += span(level);
        }
        all
    }

    /// Sum of these rows; the work grows with the logarithm of their number.
    pub(crate) fn sum(&self, rows: Range<usize>) -> ColumnSum {
        let mut all = ColumnSum::default();
        let mut row = rows.start;
        while row < rows.end {
            let level = self.level_at(row, rows.end);
            let ring = level
                .checked_sub(SUMS_FROM)
                .and_then(|above| self.sums.get(usize::try_from(above).ok()?));
            if let Some(stretch) = ring.and_then(|ring| ring.get(row >> (FACTOR_SHIFT * level))) {
                all.join(stretch);
                row += span(level);
            } else {
                all.push(self.values.get(row).unwrap_or(f32::NAN));
                row += 1;
            }
        }
        all
    }

    /// The highest level with a block that starts at `row` and ends at or before `end`.
    fn level_at(&self, row: usize, end: usize) -> u32 {
        (1..=LEVELS)
            .take_while(|level| row.is_multiple_of(span(*level)) && row + span(*level) <= end)
            .last()
            .unwrap_or(0)
    }

    fn stretch(&self, level: u32, row: usize) -> Option<Extremes> {
        match level.checked_sub(1) {
            None => self.values.get(row).map(Extremes::of),
            Some(above) => self
                .levels
                .get(usize::try_from(above).ok()?)?
                .get(row >> (FACTOR_SHIFT * level)),
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        self.values.bytes()
            + self.levels.iter().map(RowRing::bytes).sum::<usize>()
            + self.sums.iter().map(RowRing::bytes).sum::<usize>()
    }
}

/// Rows in one block of a level.
const fn span(level: u32) -> usize {
    1 << (FACTOR_SHIFT * level)
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a test may"
    )]
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The pyramid agrees with the values for every range, even after the ring wrapped.
        #[test]
        fn the_pyramid_equals_the_values(
            values in prop::collection::vec(prop_oneof![9 => -4000i16..4000, 1 => Just(i16::MAX)], 1..6000),
            room in 600usize..4000,
            asked in prop::collection::vec((0.0f64..1.0, 0.0f64..1.0), 20),
        ) {
            let value = |raw: &i16| if *raw == i16::MAX { f32::NAN } else { f32::from(*raw) };
            let mut column = Column::new(room);
            values.iter().for_each(|raw| column.push(value(raw)));
            let held = values.len().saturating_sub(room)..values.len();
            let row = |part: f64| held.start + (part * held.len() as f64) as usize;
            for (one, two) in asked {
                let rows = row(one.min(two))..row(one.max(two));
                let seen = values.get(rows.clone()).unwrap_or_default();
                let (mut extremes, mut sum) = (Extremes::NONE, ColumnSum::default());
                for raw in seen {
                    extremes.push(value(raw));
                    sum.push(value(raw));
                }
                prop_assert_eq!(column.extremes(rows.clone()), extremes);
                prop_assert_eq!(column.sum(rows), sum);
            }
        }
    }

    #[test]
    fn extremes_of_any_rows_are_those_of_the_values() {
        let mut column = Column::new(3000);
        let value = |row: usize| ((row * 7919) % 1013) as f32;
        for row in 0..5000 {
            column.push(value(row));
        }
        for (from, to) in [
            (2000, 5000),
            (2001, 4999),
            (2048, 2112),
            (3000, 3001),
            (2555, 2570),
        ] {
            let want = (from..to)
                .map(value)
                .fold(Extremes::NONE, |mut all, value| {
                    all.push(value);
                    all
                });
            assert_eq!(column.extremes(from..to), want, "{from}..{to}");
        }
    }

    #[test]
    fn an_unknown_value_is_a_gap_and_never_an_extreme() {
        let mut column = Column::new(100);
        for value in [1.0, f32::NAN, 3.0] {
            column.push(value);
        }
        assert_eq!(
            column.extremes(0..3),
            Extremes {
                min: 1.0,
                max: 3.0,
                gap: true
            }
        );
        assert!(column.extremes(1..2).is_empty());
    }
}
