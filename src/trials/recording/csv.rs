//! The samples of a trial as a CSV table, written and parsed. Opens no file.

use crate::hand::{Dof, Finger, Moment, PerDof, PerFinger};
use crate::store::{FileCause, FileError};
use crate::trials::recording::{
    SampleRow, TipSample, TrialEvent, TrialMark, TrialRecording, seconds,
};
use std::fmt::{Display, Write as _};
use std::str::FromStr;
use std::time::Duration;

/// Time of the closing command in a parsed table: late enough for earlier rows to have positive times.
const ZERO: Duration = Duration::from_secs(3600);
/// Quantities of a joint in column order, then those of a fingertip.
const OF_JOINTS: [&str; 6] = [
    "angle",
    "force_g",
    "current_ma",
    "status",
    "faults",
    "temp_c",
];
const OF_TIPS: [&str; 4] = ["normal_n", "tangential_n", "direction_deg", "proximity"];

fn columns() -> Vec<String> {
    let of_joints = OF_JOINTS.into_iter().flat_map(|quantity| {
        Dof::ALL
            .into_iter()
            .map(move |dof| format!("{quantity}_{}", dof.name()))
    });
    let of_tips = OF_TIPS.into_iter().flat_map(|quantity| {
        Finger::ALL
            .into_iter()
            .map(move |finger| format!("{quantity}_{}", finger.name()))
    });
    let first = std::iter::once("time_s".to_owned());
    let all = first.chain(of_joints).chain(of_tips);
    all.chain(std::iter::once("event".to_owned())).collect()
}

/// Comma-separated values, one line per row and event: `time_s` from [`TrialRecording::zero`], six columns per joint quantity, five
/// per fingertip quantity, and `event`. A quantity without a reading at that time is an empty cell.
pub fn write(recording: &TrialRecording) -> String {
    let mut text = columns().join(",");
    text.push('\n');
    let zero = recording.zero();
    let mark_line = |text: &mut String, mark: &TrialMark| {
        let at_s = seconds(zero, mark.at);
        line(text, at_s, &SampleRow::default(), &mark.what.name());
    };
    let mut marks = recording.marks().iter().peekable();
    for row in recording.rows() {
        while let Some(mark) = marks.next_if(|mark| mark.at <= row.at) {
            mark_line(&mut text, mark);
        }
        line(&mut text, seconds(zero, row.at), row, "");
    }
    marks.for_each(|mark| mark_line(&mut text, mark));
    text
}

fn line(text: &mut String, at_s: f64, row: &SampleRow, event: &str) {
    // Writing to a string cannot fail.
    let _done = write!(text, "{at_s:.6}");
    for group in [row.angle, row.force, row.current] {
        six(text, group);
    }
    for group in [row.status, row.faults, row.temperature] {
        six(text, group);
    }
    five(text, row, |tip| tip.normal_n);
    five(text, row, |tip| tip.tangential_n);
    five(text, row, |tip| tip.direction_deg);
    five(text, row, |tip| Some(tip.proximity));
    let _done = writeln!(text, ",{event}");
}

fn six<T: Display>(text: &mut String, group: Option<PerDof<T>>) {
    for dof in Dof::ALL {
        cell(text, group.as_ref().map(|group| &group[dof]));
    }
}

fn five<T: Display>(text: &mut String, row: &SampleRow, value: fn(&TipSample) -> Option<T>) {
    for (_, tip) in row.tips.iter() {
        cell(text, tip.as_ref().and_then(value));
    }
}

fn cell(text: &mut String, value: Option<impl Display>) {
    text.push(',');
    if let Some(value) = value {
        let _done = write!(text, "{value}");
    }
}

fn error_in(line: usize, cause: FileCause) -> FileError {
    FileError {
        line: Some(line),
        ..cause.into()
    }
}

/// Parses a table.
///
/// # Errors
/// [`FileError`]: the first error.
pub fn read(csv: &str) -> Result<TrialRecording, FileError> {
    let mut lines = csv.lines().enumerate();
    let columns = columns();
    let head = lines.next().map(|(_, head)| head);
    if head != Some(columns.join(",").as_str()) {
        return Err(error_in(1, FileCause::NotSamples));
    }
    let mut recording = TrialRecording::default();
    for (at, text) in lines {
        let cells: Vec<&str> = text.split(',').collect();
        let line = at + 1;
        let (got, want) = (cells.len(), columns.len());
        if got != want {
            let what = format!("{got} cells instead of {want}");
            return Err(error_in(line, FileCause::Malformed(what)));
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

/// One line, parsed cell by cell.
struct Cells<'a> {
    line: usize,
    columns: &'a [String],
    cells: &'a [&'a str],
    at: usize,
}

impl Cells<'_> {
    fn read(&mut self, recording: &mut TrialRecording) -> Result<(), FileError> {
        let seconds = self.next::<f64>()?;
        let after = seconds.map(|seconds| seconds + ZERO.as_secs_f64());
        let after = after.and_then(|after| Duration::try_from_secs_f64(after).ok());
        let at = Moment::ZERO.plus(after.ok_or_else(|| self.wrong(0))?);
        let row = SampleRow {
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
            recording.mark(at, what);
        }
        Ok(())
    }

    fn wrong(&self, at: usize) -> FileError {
        let column = self.columns.get(at).map_or("", String::as_str);
        let text = self.cells.get(at).copied().unwrap_or_default();
        let what = format!("'{text}' is not a valid {column}");
        error_in(self.line, FileCause::Malformed(what))
    }

    /// The next cell; `None` if it is empty.
    fn next<T: FromStr>(&mut self) -> Result<Option<T>, FileError> {
        let at = self.at;
        self.at += 1;
        let text = self.cells.get(at).copied().unwrap_or_default();
        if text.is_empty() {
            return Ok(None);
        }
        text.parse().map(Some).map_err(|_no_number| self.wrong(at))
    }

    /// The values of all joints; `None` if one is missing.
    fn six<T: FromStr>(&mut self) -> Result<Option<PerDof<T>>, FileError> {
        let mut values: PerDof<Option<T>> = PerDof::from_fn(|_| None);
        for dof in Dof::ALL {
            values[dof] = self.next()?;
        }
        Ok(values.all())
    }

    fn tips(&mut self) -> Result<PerFinger<Option<TipSample>>, FileError> {
        let (normal, tangential) = (self.five()?, self.five()?);
        let direction = self.five()?;
        let proximity: PerFinger<Option<i32>> = self.five()?;
        Ok(PerFinger::from_fn(|finger| {
            Some(TipSample {
                normal_n: normal[finger],
                tangential_n: tangential[finger],
                direction_deg: direction[finger],
                proximity: proximity[finger]?,
            })
        }))
    }

    fn five<T: FromStr>(&mut self) -> Result<PerFinger<Option<T>>, FileError> {
        let mut values = PerFinger::from_fn(|_| None);
        for finger in Finger::ALL {
            values[finger] = self.next()?;
        }
        Ok(values)
    }
}

fn what(name: &str) -> Option<TrialEvent> {
    let plain = [
        TrialEvent::Prepare,
        TrialEvent::Limits,
        TrialEvent::Close,
        TrialEvent::Stopped,
        TrialEvent::NotStopped,
        TrialEvent::Release,
        TrialEvent::Released,
        TrialEvent::Aborted,
    ];
    let slow = Dof::ALL.map(TrialEvent::Slow);
    let mut all = plain.into_iter().chain(slow);
    all.find(|what| what.name() == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> TrialRecording {
        let mut recording = TrialRecording::default();
        let at = |millis: u64| Moment::from_micros(millis * 1000);
        let tip = TipSample {
            normal_n: Some(0.25),
            tangential_n: None,
            direction_deg: Some(359),
            proximity: -12,
        };
        recording.push_row(SampleRow {
            at: at(900),
            angle: Some(PerDof::splat(-3)),
            status: Some(PerDof::splat(2)),
            ..SampleRow::default()
        });
        recording.mark(at(1000), TrialEvent::Close);
        recording.push_row(SampleRow {
            at: at(1010),
            force: Some(PerDof::splat(-4000)),
            tips: PerFinger::from_fn(|finger| (finger == Finger::Index).then_some(tip)),
            ..SampleRow::default()
        });
        recording.mark(at(1020), TrialEvent::Slow(Dof::Index));
        recording.mark(at(1500), TrialEvent::Aborted);
        recording
    }

    #[test]
    fn what_was_written_is_read_back() {
        let csv = write(&sample());
        let back = read(&csv).unwrap();
        assert_eq!(write(&back), csv);
        assert_eq!(back.rows().len(), 2);
    }

    #[test]
    fn a_spoilt_table_says_where() {
        let csv = write(&sample());
        assert_eq!(read("a,b\n1,2\n"), Err(error_in(1, FileCause::NotSamples)));
        assert_eq!(read(""), Err(error_in(1, FileCause::NotSamples)));
        for (from, to, words) in [
            ("359", "x", "line 4, 'x' is not a valid direction_deg_index"),
            ("-4000,-4000", "-4000", "line 4, 57 cells instead of 58"),
            ("close", "closed", "line 3, 'closed' is not a valid event"),
            ("-0.100000", "nan", "line 2, 'nan' is not a valid time_s"),
            ("0.010000", "1e300", "line 4, '1e300' is not a valid time_s"),
        ] {
            let error = read(&csv.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.to_string(), words);
        }
    }
}
