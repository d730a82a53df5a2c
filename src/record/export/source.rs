//! A time range of a recording as the input of an export: read entry by entry, with progress and cancellation.

use crate::hand::{Dof, Moment};
use crate::record::Entry;
use crate::record::export::output::{ExportError, Unfinished};
use crate::record::file::RecordingFile;
use crate::record::file::reader::{Damage, TimeRange};
use crate::record::grip::GripFollower;
use mcap::McapError;
use parquet::errors::ParquetError;
use std::io;
use std::ops::ControlFlow;

/// Entries between two progress reports: some milliseconds.
const POLL_ENTRIES: u64 = 256;

/// Receives the progress of an export, from 0 to 1. Cancels it by returning `Break`.
pub type ProgressFn<'a> = dyn Fn(f64) -> ControlFlow<()> + 'a;

/// A time range of a recording to export.
#[derive(Clone, Copy)]
pub struct ExportSource<'a> {
    pub file: &'a RecordingFile,
    pub stretch: TimeRange,
    /// Receives the progress.
    pub watch: &'a ProgressFn<'a>,
}

/// Reason why a time range was not read or written to its end.
#[derive(Debug)]
pub(crate) enum Broken {
    /// The recording cannot be read to its end.
    Source(io::Error),
    /// The export cannot be written.
    Output(io::Error),
    /// The exported table cannot be written.
    Table(ParquetError),
    /// The user cancelled the export.
    Interrupted,
}

impl Broken {
    /// Converts to the error of this export.
    pub(crate) fn of(self, output: &Unfinished) -> ExportError {
        match self {
            Self::Source(error) => ExportError::Unreadable {
                error: error.into(),
            },
            Self::Output(error) => output.error(&error),
            Self::Table(error) => output.parquet_error(error),
            Self::Interrupted => ExportError::Interrupted,
        }
    }
}

impl From<io::Error> for Broken {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

impl From<McapError> for Broken {
    fn from(error: McapError) -> Self {
        Self::Output(io::Error::other(error))
    }
}

impl From<ParquetError> for Broken {
    fn from(error: ParquetError) -> Self {
        Self::Table(error)
    }
}

impl<'a> ExportSource<'a> {
    /// Joints whose newtons were known, each with those of a gram.
    pub(crate) fn newtons_per_g(&self) -> Vec<(Dof, f64)> {
        self.file.opening().newtons().collect()
    }

    /// A time range without progress reports.
    pub fn new(file: &'a RecordingFile, stretch: TimeRange) -> Self {
        let watch = &|_| ControlFlow::Continue(());
        Self {
            file,
            stretch,
            watch,
        }
    }

    /// Omits the bytes on the wire.
    pub(crate) const fn without_wire(mut self) -> Self {
        self.stretch.wire = false;
        self
    }

    /// State of the grip before the time range, on which the grip within it depends.
    pub(crate) fn grip_before(&self) -> Result<GripFollower, Broken> {
        let mut grip = GripFollower::default();
        let from = self.stretch.from;
        if from <= self.file.first() {
            return Ok(grip);
        }
        // Progress starts with the time range.
        let watch = |_| (self.watch)(0.0);
        let mut before = ExportSource {
            watch: &watch,
            ..self.without_wire()
        };
        before.stretch.from = Moment::ZERO;
        before.stretch.to = Moment::from_micros(from.micros() - 1);
        before.entries(|entry| {
            grip.apply(&entry);
            Ok(())
        })?;
        Ok(grip)
    }

    /// Passes each entry to `take`, until that fails.
    pub(crate) fn entries(
        &self,
        mut take: impl FnMut(Entry) -> Result<(), Broken>,
    ) -> Result<Damage, Broken> {
        let mut done = self.report_progress(self.stretch.from);
        let mut count = 0_u64;
        let damage = self.file.entries(self.stretch, |entry| {
            count += 1;
            if count.is_multiple_of(POLL_ENTRIES) && done.is_ok() {
                done = self.report_progress(entry.at());
            }
            if done.is_ok() {
                done = take(entry);
            }
            match done {
                Ok(()) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            }
        });
        let damage = damage.map_err(Broken::Source)?;
        done.map(|()| damage)
    }

    /// Reports the progress.
    fn report_progress(&self, at: Moment) -> Result<(), Broken> {
        let from = self.stretch.from.max(self.file.first());
        let whole = self.stretch.to.min(self.file.last()).since(from);
        let share = at.since(from).as_secs_f64() / whole.as_secs_f64().max(1e-6);
        match (self.watch)(share.min(1.0)) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Broken::Interrupted),
        }
    }
}
