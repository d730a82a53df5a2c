//! User metadata of a recording, in a small file next to it: name, star, notes. The recording itself is never changed.

use crate::hand::Moment;
use crate::record::EventKind;
use crate::record::file::FileMark;
use crate::store::toml_file::{self, FileText};
use crate::store::{FileError, replace, set_aside};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Maximum size of the metadata file in bytes: room for about a thousand notes.
const FILE_LEN_MAX: u64 = 1024 * 1024;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordingNote {
    /// Timestamp in microseconds on the recording's own clock.
    pub at_micros: u64,
    pub words: String,
}

/// User metadata of a recording.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct RecordingAbout {
    /// Name given by the user; empty if none.
    pub name: String,
    /// True if the recording is exempt from the storage budget.
    pub star: bool,
    /// Notes edited by the user, which replace those in the recording; `None` if they are unedited.
    pub notes: Option<Vec<RecordingNote>>,
    /// Keys from a later version, preserved on save.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl RecordingAbout {
    /// Path of the metadata file of a recording.
    pub fn path(recording: &Path) -> PathBuf {
        recording.with_extension("toml")
    }

    /// Loads the metadata; a recording without a metadata file gets the default.
    ///
    /// # Errors
    /// [`FileError`] if the file cannot be read, with the location.
    pub fn load(recording: &Path) -> Result<Self, FileError> {
        let path = Self::path(recording);
        if matches!(path.try_exists(), Ok(false)) {
            return Ok(Self::default());
        }
        toml_file::load(&path, FILE_LEN_MAX, |text| FileText::plain(text).parse())
    }

    /// Saves the metadata. An existing file that cannot be read is set aside.
    ///
    /// # Errors
    /// The I/O error of the system.
    pub fn save(&self, recording: &Path) -> io::Result<()> {
        let text = toml::to_string_pretty(self).map_err(io::Error::other)?;
        if Self::load(recording).is_err() {
            // Preserves manual edits under another name.
            let _aside = set_aside(&Self::path(recording));
        }
        replace(&Self::path(recording), text.as_bytes())
    }

    /// Effective notes: the user's, else those in the recording.
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

    /// True if the budget must not delete the recording.
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
