//! Measurements as CSV text: one line for each moment at which something was received. Writes no file.

use crate::hand::column::text_cell;
use std::fmt::Write as _;

/// Columns with common times.
#[derive(Debug, Clone, PartialEq)]
pub struct TableGroup {
    /// Times of the rows, in seconds, never decreasing.
    pub times: Vec<f64>,
    /// Header and values of each column; NaN = unknown.
    pub columns: Vec<(String, Vec<f32>)>,
}

/// A copy of measurements, independent of the history.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    groups: Vec<TableGroup>,
    marks: Vec<(f64, String)>,
}

/// Measurements and event of one moment.
struct TableLine<'a> {
    time_s: f64,
    /// Row of each group; `None` if it has none at this moment.
    rows: Vec<Option<usize>>,
    event: Option<&'a str>,
}

impl Table {
    pub(crate) const fn new(groups: Vec<TableGroup>, marks: Vec<(f64, String)>) -> Self {
        Self { groups, marks }
    }

    /// Adds columns and marks.
    pub fn with(mut self, group: TableGroup, marks: Vec<(f64, String)>) -> Self {
        self.groups.push(group);
        self.marks.extend(marks);
        self.marks.sort_by(|one, two| one.0.total_cmp(&two.0));
        self
    }

    /// Number of text lines after the header. The work grows with the measurements.
    pub fn rows(&self) -> usize {
        self.lines().count()
    }

    /// Comma-separated values: `time_s` since the start of the program, then the columns with their units, then the event. An
    /// unmeasured or unknown value is an empty cell; a line of empty cells is a break.
    pub fn csv(&self) -> String {
        let mut text = String::from("time_s");
        for (name, _) in self.groups.iter().flat_map(|group| &group.columns) {
            text.push(',');
            text.push_str(name);
        }
        text.push_str(",event\n");
        for line in self.lines() {
            // Writing to a string cannot fail.
            let _done = write!(text, "{:.6}", line.time_s);
            for (group, row) in self.groups.iter().zip(line.rows) {
                for (_, values) in &group.columns {
                    text.push(',');
                    let value = row.and_then(|row| values.get(row));
                    if let Some(value) = value.filter(|value| !value.is_nan()) {
                        let _done = write!(text, "{value}");
                    }
                }
            }
            text.push(',');
            text.push_str(&line.event.map(text_cell).unwrap_or_default());
            text.push('\n');
        }
        text
    }

    /// One line for each moment, ordered by time.
    fn lines(&self) -> impl Iterator<Item = TableLine<'_>> {
        let mut next = vec![0; self.groups.len()];
        let mut marks = self.marks.iter().peekable();
        std::iter::from_fn(move || {
            let times = self.groups.iter().zip(&next);
            let times = times.filter_map(|(group, row)| group.times.get(*row).copied());
            let time_s = times
                .chain(marks.peek().map(|mark| mark.0))
                .reduce(f64::min)?;
            let rows = self.groups.iter().zip(&mut next).map(|(group, next)| {
                let row = *next;
                let is_here = group.times.get(row).is_some_and(|at_s| *at_s <= time_s);
                *next += usize::from(is_here);
                is_here.then_some(row)
            });
            Some(TableLine {
                time_s,
                rows: rows.collect(),
                event: marks
                    .next_if(|mark| mark.0 <= time_s)
                    .map(|mark| mark.1.as_str()),
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_moment_is_a_line_and_what_is_not_known_is_an_empty_cell() {
        let column = |name: &str, values: &[f32]| (name.to_owned(), values.to_vec());
        let table = Table::new(
            vec![
                TableGroup {
                    times: vec![1.0, 1.01, 1.01],
                    columns: vec![
                        column("force_index_g", &[5.0, -7.0, f32::NAN]),
                        column("force_ring_g", &[6.0, f32::NAN, f32::NAN]),
                    ],
                },
                TableGroup {
                    times: vec![1.01, 1.5],
                    columns: vec![column("normal_thumb_N", &[0.25, 1.5])],
                },
            ],
            vec![(1.2, "stop".into()), (1.5, "note: \"ok\", once".into())],
        );
        let lines = [
            "time_s,force_index_g,force_ring_g,normal_thumb_N,event",
            "1.000000,5,6,,",
            "1.010000,-7,,0.25,",
            "1.010000,,,,",
            "1.200000,,,,stop",
            "1.500000,,,1.5,\"note: \"\"ok\"\", once\"",
            "",
        ];
        assert_eq!(table.csv(), lines.join("\n"));
        assert_eq!(table.rows(), 5);
    }

    #[test]
    fn an_empty_table_has_its_head() {
        assert_eq!(Table::new(Vec::new(), Vec::new()).csv(), "time_s,event\n");
    }
}
