//! Reads the samples of a trial back from the table that [`crate::app::trial::recording::Recording::csv`] writes. Opens no file.

use crate::app::trial::recording::{Mark, Recording, Row, Tip, What, columns};
use crate::hand::{Dof, Finger, Moment, PerDof, PerFinger};
use std::str::FromStr;
use std::time::Duration;

/// Where the closing command stands in time: late enough that what was before it has a place.
const ZERO: Duration = Duration::from_secs(3600);

/// Why a table is not one of samples.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// The first line is another.
    #[error("line 1: this is no table of samples")]
    Head,
    /// A line is too long or too short.
    #[error("line {line}: {got} cells in place of {want}")]
    Cells {
        /// 1 the first.
        line: usize,
        /// How many.
        got: usize,
        /// How many there should be.
        want: usize,
    },
    /// A cell does not hold what it should.
    #[error("line {line}: '{text}' is no {column}")]
    Cell {
        /// 1 the first.
        line: usize,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
}

/// Reads a table.
///
/// # Errors
/// [`TableError`]: the first thing that is wrong.
pub fn recording(csv: &str) -> Result<Recording, TableError> {
    let mut lines = csv.lines().enumerate();
    let columns = columns();
    let head = lines.next().map(|(_, head)| head);
    if head != Some(columns.join(",").as_str()) {
        return Err(TableError::Head);
    }
    let mut recording = Recording::default();
    for (at, text) in lines {
        let cells: Vec<&str> = text.split(',').collect();
        let line = at + 1;
        let (got, want) = (cells.len(), columns.len());
        if got != want {
            return Err(TableError::Cells { line, got, want });
        }
        let mut cells = Cells {
            line,
            columns: &columns,
            cells: &cells,
            at: 0,
        };
        cells.read(&mut recording)?;
    }
    Ok(recording)
}

/// One line, cell by cell.
struct Cells<'a> {
    line: usize,
    columns: &'a [String],
    cells: &'a [&'a str],
    at: usize,
}

impl Cells<'_> {
    fn read(&mut self, recording: &mut Recording) -> Result<(), TableError> {
        let seconds = self.next::<f64>()?;
        let after = seconds.map(|seconds| seconds + ZERO.as_secs_f64());
        let after = after.and_then(|after| Duration::try_from_secs_f64(after).ok());
        let at = Moment::ZERO.plus(after.ok_or_else(|| self.wrong(0))?);
        let row = Row {
            at,
            angle: self.six()?,
            force: self.six()?,
            current: self.six()?,
            status: self.six()?,
            faults: self.six()?,
            temperature: self.six()?,
            tips: self.tips()?,
        };
        let event = self.cells.get(self.at).copied().unwrap_or_default();
        if event.is_empty() {
            recording.push_row(row);
        } else {
            let what = what(event).ok_or_else(|| self.wrong(self.at))?;
            recording.push_mark(Mark { at, what });
        }
        Ok(())
    }

    fn wrong(&self, at: usize) -> TableError {
        TableError::Cell {
            line: self.line,
            column: self.columns.get(at).cloned().unwrap_or_default(),
            text: self.cells.get(at).copied().unwrap_or_default().into(),
        }
    }

    /// The next cell; none if it is empty.
    fn next<T: FromStr>(&mut self) -> Result<Option<T>, TableError> {
        let at = self.at;
        self.at += 1;
        let text = self.cells.get(at).copied().unwrap_or_default();
        if text.is_empty() {
            return Ok(None);
        }
        text.parse().map(Some).map_err(|_no_number| self.wrong(at))
    }

    /// A group of all joints; none if one is missing.
    fn six<T: FromStr>(&mut self) -> Result<Option<PerDof<T>>, TableError> {
        let mut values: PerDof<Option<T>> = PerDof::from_fn(|_| None);
        for dof in Dof::ALL {
            values[dof] = self.next()?;
        }
        Ok(values.all())
    }

    fn tips(&mut self) -> Result<PerFinger<Option<Tip>>, TableError> {
        let (normal, tangential) = (self.five()?, self.five()?);
        let direction = self.five()?;
        let proximity: PerFinger<Option<i32>> = self.five()?;
        Ok(PerFinger::from_fn(|finger| {
            Some(Tip {
                normal_n: normal[finger],
                tangential_n: tangential[finger],
                direction_deg: direction[finger],
                proximity: proximity[finger]?,
            })
        }))
    }

    fn five<T: FromStr>(&mut self) -> Result<PerFinger<Option<T>>, TableError> {
        let mut values = PerFinger::from_fn(|_| None);
        for finger in Finger::ALL {
            values[finger] = self.next()?;
        }
        Ok(values)
    }
}

fn what(name: &str) -> Option<What> {
    let plain = [
        What::Prepare,
        What::Limits,
        What::Close,
        What::Stopped,
        What::NotStopped,
        What::Release,
        What::Released,
        What::Aborted,
    ];
    let slow = Dof::ALL.map(What::Slow);
    let mut all = plain.into_iter().chain(slow);
    all.find(|what| what.name() == name)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    fn sample() -> Recording {
        let mut recording = Recording::default();
        let at = |millis: u64| Moment::from_micros(millis * 1000);
        let tip = Tip {
            normal_n: Some(0.25),
            tangential_n: None,
            direction_deg: Some(359),
            proximity: -12,
        };
        recording.push_row(Row {
            at: at(900),
            angle: Some(PerDof::splat(-3)),
            status: Some(PerDof::splat(2)),
            ..Row::default()
        });
        recording.mark(at(1000), What::Close);
        recording.push_row(Row {
            at: at(1010),
            force: Some(PerDof::splat(-4000)),
            tips: PerFinger::from_fn(|finger| (finger == Finger::Index).then_some(tip)),
            ..Row::default()
        });
        recording.mark(at(1020), What::Slow(Dof::Index));
        recording.mark(at(1500), What::Aborted);
        recording
    }

    #[test]
    fn what_was_written_is_read_back() {
        let csv = sample().csv();
        let read = recording(&csv).unwrap();
        assert_eq!(read.csv(), csv);
        assert_eq!(read.rows().len(), 2);
    }

    #[test]
    fn a_spoilt_table_says_where() {
        let csv = sample().csv();
        assert_eq!(recording("a,b\n1,2\n"), Err(TableError::Head));
        assert_eq!(recording(""), Err(TableError::Head));
        for (from, to, words) in [
            ("359", "x", "line 4: 'x' is no direction_deg_index"),
            ("-4000,-4000", "-4000", "line 4: 57 cells in place of 58"),
            ("close", "closed", "line 3: 'closed' is no event"),
            ("-0.100000", "nan", "line 2: 'nan' is no time_s"),
            ("0.010000", "1e300", "line 4: '1e300' is no time_s"),
        ] {
            let error = recording(&csv.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.to_string(), words);
        }
    }
}
