//! A file or folder that takes its place only when it is whole, and is gone if it does not become whole.

use crate::record::file::reader::Damage;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// Why nothing was exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// Something has that name.
    #[error("{} is already there and is not overwritten", .path.display())]
    Exists {
        /// What.
        path: PathBuf,
    },
    /// The system does not let it be written.
    #[error("cannot write {}: {message}", .path.display())]
    Unwritable {
        /// What.
        path: PathBuf,
        /// What the system says.
        message: String,
    },
    /// The session cannot be read on.
    #[error("cannot read the session to its end: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// There is nothing of this kind in the stretch.
    #[error("there is no reading of the joints in this stretch")]
    Empty,
}

/// What was exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exported {
    /// Rows of a table, or messages.
    pub rows: u64,
    /// What of the session could not be read and is not in it.
    pub damage: Damage,
}

/// Something that is being written.
#[derive(Debug)]
pub(crate) struct Unfinished {
    wanted: PathBuf,
    beside: PathBuf,
}

impl Unfinished {
    /// For this place, which must be free.
    pub(crate) fn new(wanted: &Path) -> Result<Self, ExportError> {
        if wanted.symlink_metadata().is_ok() {
            return Err(ExportError::Exists {
                path: wanted.to_owned(),
            });
        }
        let name = wanted.file_name().unwrap_or_default().to_string_lossy();
        let beside = format!(".{name}.{}.part", std::process::id());
        Ok(Self {
            beside: wanted.with_file_name(beside),
            wanted: wanted.to_owned(),
        })
    }

    /// The place, for errors.
    pub(crate) fn error(&self, error: &io::Error) -> ExportError {
        ExportError::Unwritable {
            path: self.wanted.clone(),
            message: error.to_string(),
        }
    }

    /// The file, in its temporary place.
    pub(crate) fn file(&self) -> Result<BufWriter<File>, ExportError> {
        let made = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&self.beside);
        made.map(BufWriter::new).map_err(|error| self.error(&error))
    }

    /// The folder, in its temporary place.
    pub(crate) fn folder(&self) -> Result<&Path, ExportError> {
        let made = fs::create_dir(&self.beside);
        made.map_err(|error| self.error(&error))?;
        Ok(&self.beside)
    }

    /// A file that is written in full goes to the disk.
    pub(crate) fn sync(&self, file: BufWriter<File>) -> Result<(), ExportError> {
        let file = file.into_inner().map_err(io::IntoInnerError::into_error);
        file.and_then(|file| file.sync_all())
            .map_err(|error| self.error(&error))
    }

    /// Takes the place.
    pub(crate) fn finish(self) -> Result<(), ExportError> {
        if self.wanted.symlink_metadata().is_ok() {
            return Err(ExportError::Exists {
                path: self.wanted.clone(),
            });
        }
        fs::rename(&self.beside, &self.wanted).map_err(|error| self.error(&error))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        // One that took its place is not here any more; what cannot be removed stays beside, under a name that tells.
        let _gone = match self.beside.is_dir() {
            true => fs::remove_dir_all(&self.beside),
            false => fs::remove_file(&self.beside),
        };
    }
}

/// The session cannot be read on.
pub(crate) fn unreadable(error: &io::Error) -> ExportError {
    ExportError::Unreadable {
        message: error.to_string(),
    }
}
