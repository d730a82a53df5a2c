//! A stretch of a session as a session file of its own: closed, with an index, made anew of what could be read.

use crate::record::export::output::{ExportError, Exported, Unfinished, unreadable};
use crate::record::file::reader::{Damage, Stretch};
use crate::record::file::writer::SessionWriter;
use crate::record::file::{Opening, SessionFile};
use crate::record::{Entry, Event, EventKind};
use mcap::McapError;
use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::ops::ControlFlow;
use std::path::Path;

/// Entries between two writes to the disk: some hundred kilobytes.
const ENTRIES_AT_ONCE: u64 = 1024;

/// Writes a stretch.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub fn write(file: &SessionFile, stretch: Stretch, path: &Path) -> Result<Exported, ExportError> {
    let output = Unfinished::new(path)?;
    let (exported, to) =
        copy(file, stretch, output.file()?, |_| None).map_err(|error| error.of(&output))?;
    output.sync(to)?;
    output.finish()?;
    Ok(exported)
}

/// Writes all that can be read of a damaged file, and at its end what was lost.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub fn recover(file: &SessionFile, path: &Path) -> Result<Exported, ExportError> {
    let output = Unfinished::new(path)?;
    let said = |damage: Damage| (damage != Damage::default()).then(|| recovered(file, damage));
    let (exported, to) =
        copy(file, Stretch::WHOLE, output.file()?, said).map_err(|error| error.of(&output))?;
    output.sync(to)?;
    output.finish()?;
    Ok(exported)
}

fn recovered(file: &SessionFile, damage: Damage) -> Event {
    Event {
        at: file.last(),
        kind: EventKind::Recording,
        words: format!(
            "recovered from a damaged file: {} pieces and {} bytes were lost",
            damage.chunks, damage.bytes
        ),
    }
}

/// Why a copy broke off.
#[derive(Debug)]
pub(crate) enum CopyError {
    /// The session cannot be read on.
    Source(io::Error),
    /// The copy cannot be written.
    Copy(io::Error),
}

impl CopyError {
    /// For what was to be written.
    pub(crate) fn of(&self, output: &Unfinished) -> ExportError {
        match self {
            Self::Source(error) => unreadable(error),
            Self::Copy(error) => output.error(error),
        }
    }
}

impl From<McapError> for CopyError {
    fn from(error: McapError) -> Self {
        Self::Copy(io::Error::other(error))
    }
}

/// Copies a stretch, and then what is to be said of what could not be read.
pub(crate) fn copy(
    file: &SessionFile,
    stretch: Stretch,
    to: BufWriter<File>,
    said: impl FnOnce(Damage) -> Option<Event>,
) -> Result<(Exported, BufWriter<File>), CopyError> {
    let opening = Opening {
        began: stretch.from.max(file.first()),
        ..file.opening().clone()
    };
    let mut copy = SessionCopy::new(&opening, to)?;
    let mut done = Ok(());
    let damage = file.entries(stretch, |entry| {
        done = copy.push(&entry);
        match done {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    });
    let damage = damage.map_err(CopyError::Source)?;
    done?;
    if let Some(event) = said(damage) {
        copy.push(&Entry::Event(event))?;
    }
    let (rows, to) = copy.end()?;
    Ok((Exported { rows, damage }, to))
}

/// A session file that is made of entries.
pub(crate) struct SessionCopy {
    writer: SessionWriter,
    to: BufWriter<File>,
    rows: u64,
}

impl SessionCopy {
    pub(crate) fn new(opening: &Opening, to: BufWriter<File>) -> Result<Self, CopyError> {
        Ok(Self {
            writer: SessionWriter::new(opening)?,
            to,
            rows: 0,
        })
    }

    pub(crate) fn push(&mut self, entry: &Entry) -> Result<(), CopyError> {
        self.writer.push(entry)?;
        self.rows += 1;
        match self.rows.is_multiple_of(ENTRIES_AT_ONCE) {
            true => self.put(),
            false => Ok(()),
        }
    }

    fn put(&mut self) -> Result<(), CopyError> {
        let bytes = self.writer.take_bytes();
        self.to.write_all(&bytes).map_err(CopyError::Copy)
    }

    /// Ends the file; how many entries are in it.
    pub(crate) fn end(mut self) -> Result<(u64, BufWriter<File>), CopyError> {
        let end = self.writer.finish()?;
        self.put()?;
        for piece in end {
            self.to.write_all(&piece).map_err(CopyError::Copy)?;
        }
        self.to.flush().map_err(CopyError::Copy)?;
        Ok((self.rows, self.to))
    }
}
