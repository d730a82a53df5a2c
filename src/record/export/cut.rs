//! A time range of a recording as a separate recording file: closed, with an index, rebuilt from the readable entries.

use crate::record::export::output::{Destination, ExportError, Exported, Unfinished};
use crate::record::export::source::{Broken, ExportSource};
use crate::record::file::reader::Damage;
use crate::record::file::writer::{Counted, RecordingWriter};
use crate::record::file::{Opening, RecordingFile};
use crate::record::grip::GripFollower;
use crate::record::{Entry, Event, EventKind, Record};
use std::io::Write;

/// Entries between two writes to the disk: some hundred kilobytes.
const ENTRIES_AT_ONCE: u64 = 1024;

/// Writes a time range.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub(crate) fn write(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    put(source, to, |_| None)
}

/// Writes all readable entries of a damaged file, and a final event that reports the loss.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub fn recover(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    put(source, to, |damage| {
        (*damage != Damage::default()).then(|| recovered(source.file, damage))
    })
}

fn put(
    source: ExportSource<'_>,
    to: &Destination,
    event_of: impl FnOnce(&Damage) -> Option<Event>,
) -> Result<Exported, ExportError> {
    let output = Unfinished::new(to)?;
    let copied = copy(source, output.file()?, event_of).map_err(|error| error.of(&output))?;
    output.sync(copied.to)?;
    output.finish(copied.exported.rows)?;
    Ok(copied.exported)
}

fn recovered(file: &RecordingFile, damage: &Damage) -> Event {
    Event {
        at: file.last(),
        kind: EventKind::Recording,
        words: format!(
            "recovered from a damaged file: {} pieces and {} bytes were lost",
            damage.chunks, damage.bytes
        ),
    }
}

/// A finished copy.
pub(crate) struct Copied<W> {
    pub(crate) exported: Exported,
    pub(crate) counted: Counted,
    pub(crate) to: W,
}

/// Copies a time range, and then the event that `said` returns for its damage.
pub(crate) fn copy<W: Write>(
    source: ExportSource<'_>,
    to: W,
    event_of: impl FnOnce(&Damage) -> Option<Event>,
) -> Result<Copied<W>, Broken> {
    let opening = Opening {
        began: source.stretch.from.max(source.file.first()),
        part: None,
        ..source.file.opening().clone()
    };
    let mut copy = RecordingCopy::after(&opening, to, source.grip_before()?)?;
    let damage = source.entries(|entry| copy.push(&entry))?;
    if let Some(event) = event_of(&damage) {
        copy.push(&Entry::Event(event))?;
    }
    let mut copied = copy.end()?;
    copied.exported.damage = damage;
    Ok(copied)
}

/// A recording file built from entries.
pub(crate) struct RecordingCopy<W> {
    writer: RecordingWriter,
    to: W,
    rows: u64,
    readings: u64,
}

impl<W: Write> RecordingCopy<W> {
    /// Starts a file with no preceding entries.
    pub(crate) fn new(opening: &Opening, to: W) -> Result<Self, Broken> {
        Self::after(opening, to, GripFollower::default())
    }

    /// Starts a file with the grip state before its first entry.
    fn after(opening: &Opening, to: W, grip: GripFollower) -> Result<Self, Broken> {
        Ok(Self {
            writer: RecordingWriter::copy(opening, grip)?,
            to,
            rows: 0,
            readings: 0,
        })
    }

    pub(crate) fn push(&mut self, entry: &Entry) -> Result<(), Broken> {
        self.writer.push(entry)?;
        self.rows += 1;
        self.readings += u64::from(matches!(entry, Entry::Heard(Record::Reading { .. })));
        if self.rows.is_multiple_of(ENTRIES_AT_ONCE) {
            self.put()
        } else {
            Ok(())
        }
    }

    fn put(&mut self) -> Result<(), Broken> {
        let bytes = self.writer.take_bytes();
        Ok(self.to.write_all(&bytes)?)
    }

    /// Ends the file.
    pub(crate) fn end(mut self) -> Result<Copied<W>, Broken> {
        let counted = self.writer.finish()?;
        self.put()?;
        self.to.flush()?;
        Ok(Copied {
            exported: Exported {
                rows: self.rows,
                readings: Some(self.readings),
                ..Exported::default()
            },
            counted,
            to: self.to,
        })
    }
}
