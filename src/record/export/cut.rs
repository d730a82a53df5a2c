//! A time range of a recording as a separate recording file: closed, with an index, rebuilt from the readable entries.

use crate::record::export::output::{Destination, ExportError, Exported, Unfinished};
use crate::record::export::source::{Broken, ExportSource};
use crate::record::file::reader::Damage;
use crate::record::file::writer::{Counted, RecordingWriter};
use crate::record::file::{Opening, RecordingFile};
use crate::record::grip::GripFollower;
use crate::record::{Entry, Event, EventKind, LinkReport, Record};
use std::io::Write;

/// Entries between two writes to the disk: some hundred kilobytes.
const ENTRIES_AT_ONCE: u64 = 1024;

/// Writes a time range.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub(crate) fn write(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    put(source, to, |_| None, None)
}

/// Returns a text as it is to stand in the copy.
pub type RewriteText<'a> = dyn Fn(&str) -> String + 'a;

/// Writes a time range with all its texts rewritten: the hand's endpoint, the events, and the states of the link.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub fn rewrite(
    source: ExportSource<'_>,
    to: &Destination,
    text: &RewriteText<'_>,
) -> Result<Exported, ExportError> {
    put(source, to, |_| None, Some(text))
}

/// Writes all readable entries of a damaged file, and a final event that reports the loss.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub fn recover(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    let event_of =
        |damage: &Damage| (*damage != Damage::default()).then(|| recovered(source.file, damage));
    put(source, to, event_of, None)
}

fn put(
    source: ExportSource<'_>,
    to: &Destination,
    event_of: impl FnOnce(&Damage) -> Option<Event>,
    text: Option<&RewriteText<'_>>,
) -> Result<Exported, ExportError> {
    let output = Unfinished::new(to)?;
    let copied = copy_with(source, output.file()?, event_of, text);
    let copied = copied.map_err(|error| error.of(&output))?;
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
    copy_with(source, to, event_of, None)
}

fn copy_with<W: Write>(
    source: ExportSource<'_>,
    to: W,
    event_of: impl FnOnce(&Damage) -> Option<Event>,
    text: Option<&RewriteText<'_>>,
) -> Result<Copied<W>, Broken> {
    let mut opening = Opening {
        began: source.stretch.from.max(source.file.first()),
        part: None,
        ..source.file.opening().clone()
    };
    if let Some(text) = text {
        opening.hand = text(&opening.hand);
    }
    let mut copy = RecordingCopy::after(&opening, to, source.grip_before()?)?;
    let damage = source.entries(|entry| match text {
        Some(text) => copy.push(&rewritten(entry, text)),
        None => copy.push(&entry),
    })?;
    if let Some(event) = event_of(&damage) {
        copy.push(&Entry::Event(event))?;
    }
    let mut copied = copy.end()?;
    copied.exported.damage = damage;
    Ok(copied)
}

/// An entry with all its texts rewritten.
fn rewritten(entry: Entry, text: &RewriteText<'_>) -> Entry {
    match entry {
        Entry::Event(event) => Entry::Event(Event {
            words: text(&event.words),
            ..event
        }),
        Entry::Link(report) => Entry::Link(LinkReport {
            trouble: text(&report.trouble),
            status: text(&report.status),
            figures: text(&report.figures),
            ..report
        }),
        // Numbers, and names of this program.
        Entry::Heard(_) | Entry::Wire(_) => entry,
    }
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
