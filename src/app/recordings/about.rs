//! What the user says of a recording, in a small file beside it: its name, a star, notes. The recording itself is never changed.

use crate::hand::Moment;
use crate::record::EventKind;
use crate::record::file::FileMark;
use crate::store::toml_file::{self, FileText};
use crate::store::{FileError, replace, set_aside};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Bytes of such a file: some thousand notes.
const FILE_LEN_MAX: u64 = 1024 * 1024;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordingNote {
    /// Microseconds of the recording's own clock.
    pub at_micros: u64,
    /// What was noted.
    pub words: String,
}

/// What the user says of a recording.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct RecordingAbout {
    /// Its name; empty if it has none.
    pub name: String,
    /// Kept, whatever the budget says.
    pub star: bool,
    /// The notes as the user left them, in place of those in the recording; `None` if nobody changed them.
    pub notes: Option<Vec<RecordingNote>>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl RecordingAbout {
    /// Where it stands beside a recording.
    pub fn path(recording: &Path) -> PathBuf {
        recording.with_extension("toml")
    }

    /// Reads it; nothing is said of a recording without such a file.
    ///
    /// # Errors
    /// [`FileError`]: what cannot be read, and where.
    pub fn load(recording: &Path) -> Result<Self, FileError> {
        let path = Self::path(recording);
        if matches!(path.try_exists(), Ok(false)) {
            return Ok(Self::default());
        }
        toml_file::load(&path, FILE_LEN_MAX, |text| FileText::plain(text).parse())
    }

    /// Writes it. A file there that cannot be read is put aside.
    ///
    /// # Errors
    /// What the system says.
    pub fn save(&self, recording: &Path) -> io::Result<()> {
        let text = toml::to_string_pretty(self).map_err(io::Error::other)?;
        if Self::load(recording).is_err() {
            // Whatever the user wrote there by hand is kept under another name.
            let _aside = set_aside(&Self::path(recording));
        }
        replace(&Self::path(recording), text.as_bytes())
    }

    /// The notes in force: the user's, else those of the recording.
    pub fn notes(&self, marks: &[FileMark]) -> Vec<RecordingNote> {
        if let Some(notes) = &self.notes {
            return notes.clone();
        }
        let notes = marks.iter().filter(|mark| mark.kind == EventKind::Note);
        notes
            .map(|mark| RecordingNote {
                at_micros: mark.at.micros(),
                words: mark.words.clone(),
            })
            .collect()
    }

    /// True if the budget must leave the recording alone.
    pub fn is_kept(&self, notes_recorded: u64) -> bool {
        let notes = self
            .notes
            .as_ref()
            .map_or(notes_recorded > 0, |notes| !notes.is_empty());
        self.star || !self.name.is_empty() || notes
    }
}

impl RecordingNote {
    pub const fn at(&self) -> Moment {
        Moment::from_micros(self.at_micros)
    }
}
