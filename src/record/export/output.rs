//! Destination of an export: a file or folder that appears only when complete, and is removed otherwise; or standard output.

use crate::hand::PerDof;
use crate::record::file::reader::Damage;
use crate::system::SystemError;
use parquet::errors::ParquetError;
use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, BufWriter, Write};
#[cfg(unix)]
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

/// Reason why nothing was exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// The path already exists.
    #[error("{} already exists and is not overwritten", .path.display())]
    Exists { path: PathBuf },
    /// The system refuses to write it.
    #[error("cannot write {}: {error}", .path.display())]
    Unwritable { path: PathBuf, error: SystemError },
    /// The recording cannot be read to its end.
    #[error("cannot read the recording to its end: {error}")]
    Unreadable { error: SystemError },
    /// The time range holds nothing of this kind.
    #[error("there is nothing to export in this time range")]
    Empty,
    /// Episodes begin at notes, and there are none.
    #[error("no user note in this time range marks the start of an episode")]
    NoNotes,
    /// A left and a right hand in one data set.
    #[error(
        "a left and a right hand cannot be in one data set, because their joints have different names"
    )]
    BothSides,
    /// A data set of actions that were never commanded.
    #[error(
        "no joint was commanded in this time range, so every action would be what the hand held before"
    )]
    NeverCommanded,
    /// The user cancelled the export.
    #[error("interrupted")]
    Interrupted,
    /// The reader of standard output closed it.
    #[error("the output was closed by its reader")]
    ReaderGone,
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Exported {
    /// Rows of a table, or messages.
    pub rows: u64,
    /// Readings of the hand among the messages; `None` in a table, where each row is one.
    pub readings: Option<u64>,
    /// Parts of the recording that could not be read and are missing.
    pub damage: Damage,
}

/// Summary of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportSummary {
    /// Summary of each recording, in the order of the sources.
    pub recordings: Vec<Exported>,
    /// `None` if the format has no episodes.
    pub episodes: Option<EpisodeCounts>,
}

/// Counts of a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EpisodeCounts {
    /// Number of episodes.
    pub episodes: u64,
    /// Number of episodes in which no joint was commanded.
    pub uncommanded: u64,
    /// Number of frames whose action was not sent, but read back from the hand.
    pub read_back: u64,
    /// Number of frames in which a joint has moved away from an action that stands still.
    pub unfollowed: u64,
    /// The joints that did.
    pub unfollowed_joints: PerDof<bool>,
}

impl ExportSummary {
    /// Number of rows of all recordings, in the unit of the format.
    pub fn rows(&self) -> u64 {
        self.recordings.iter().map(|recording| recording.rows).sum()
    }
}

/// Destination of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Destination {
    /// A file or folder, which must not exist yet.
    Path(PathBuf),
    Stdout,
}

impl From<&Path> for Destination {
    fn from(path: &Path) -> Self {
        Self::Path(path.to_owned())
    }
}

impl Destination {
    /// Path of an export that is a folder, which standard output cannot be.
    pub(crate) fn folder_path(&self) -> Result<&Path, ExportError> {
        match self {
            Self::Path(path) => Ok(path),
            Self::Stdout => Err(ExportError::Unwritable {
                path: "standard output".into(),
                error: io::Error::from(io::ErrorKind::NotADirectory).into(),
            }),
        }
    }
}

/// Writer of an export's bytes.
#[derive(Debug)]
pub(crate) enum Sink {
    File(File),
    Stdout(io::Stdout),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Stdout(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Stdout(out) => out.flush(),
        }
    }
}

/// An export in progress.
#[derive(Debug)]
pub(crate) struct Unfinished {
    wanted: Destination,
    beside: PathBuf,
}

impl Unfinished {
    /// Prepares this destination, which must not exist.
    pub(crate) fn new(wanted: &Destination) -> Result<Self, ExportError> {
        let mut beside = PathBuf::new();
        if let Destination::Path(path) = wanted {
            if path.symlink_metadata().is_ok() {
                return Err(ExportError::Exists { path: path.clone() });
            }
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            beside = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
        }
        Ok(Self {
            wanted: wanted.clone(),
            beside,
        })
    }

    /// Converts the system's error on writing it.
    pub(crate) fn error(&self, error: &io::Error) -> ExportError {
        match &self.wanted {
            Destination::Stdout if error.kind() == io::ErrorKind::BrokenPipe => {
                ExportError::ReaderGone
            }
            Destination::Stdout => ExportError::Unwritable {
                path: "standard output".into(),
                error: error.into(),
            },
            Destination::Path(path) => ExportError::Unwritable {
                path: path.clone(),
                error: error.into(),
            },
        }
    }

    /// Converts the error of a table, which wraps the system's.
    pub(crate) fn parquet_error(&self, error: ParquetError) -> ExportError {
        let error = match error {
            ParquetError::External(inner) => match inner.downcast::<io::Error>() {
                Ok(error) => *error,
                Err(other) => io::Error::other(other),
            },
            error => io::Error::other(error),
        };
        self.error(&error)
    }

    /// Creates the file at its temporary path. Like the recording, only its owner can read it.
    pub(crate) fn file(&self) -> Result<BufWriter<Sink>, ExportError> {
        let sink = match self.wanted {
            Destination::Stdout => Sink::Stdout(io::stdout()),
            Destination::Path(_) => {
                let mut options = OpenOptions::new();
                #[cfg(unix)]
                options.mode(0o600);
                let made = options.write(true).create_new(true).open(&self.beside);
                Sink::File(made.map_err(|error| self.error(&error))?)
            }
        };
        Ok(BufWriter::new(sink))
    }

    /// Creates the folder at its temporary path.
    pub(crate) fn folder(&self) -> Result<&Path, ExportError> {
        self.wanted.folder_path()?;
        let mut folder = DirBuilder::new();
        #[cfg(unix)]
        folder.mode(0o700);
        let made = folder.create(&self.beside);
        made.map_err(|error| self.error(&error))?;
        Ok(&self.beside)
    }

    /// Flushes a complete file to the disk.
    pub(crate) fn sync(&self, mut file: BufWriter<Sink>) -> Result<(), ExportError> {
        let synced = file.flush().and_then(|()| match file.get_ref() {
            Sink::File(file) => file.sync_all(),
            Sink::Stdout(_) => Ok(()),
        });
        synced.map_err(|error| self.error(&error))
    }

    /// Renames to the destination, unless it has no rows.
    pub(crate) fn finish(self, rows: u64) -> Result<(), ExportError> {
        if rows == 0 {
            return Err(ExportError::Empty);
        }
        let Destination::Path(path) = &self.wanted else {
            return Ok(());
        };
        if path.symlink_metadata().is_ok() {
            return Err(ExportError::Exists { path: path.clone() });
        }
        fs::rename(&self.beside, path).map_err(|error| self.error(&error))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if self.wanted == Destination::Stdout {
            return;
        }
        // After the rename nothing is left here; if removal fails, a file with a telling name remains.
        let _gone = if self.beside.is_dir() {
            fs::remove_dir_all(&self.beside)
        } else {
            fs::remove_file(&self.beside)
        };
    }
}

/// A folder of several exports, which appears only when complete.
#[derive(Debug)]
pub(crate) struct Folder(Unfinished);

impl Folder {
    /// Prepares this destination, which must not exist.
    pub(crate) fn new(wanted: &Destination) -> Result<Self, ExportError> {
        let folder = Unfinished::new(wanted)?;
        folder.folder()?;
        Ok(Self(folder))
    }

    /// Temporary path of the folder.
    pub(crate) fn path(&self) -> &Path {
        &self.0.beside
    }

    /// Renames to the destination.
    pub(crate) fn finish(self, rows: u64) -> Result<(), ExportError> {
        self.0.finish(rows)
    }
}
