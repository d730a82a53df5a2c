//! Where an export goes: a file or folder that takes its place only when it is whole, and is gone if it does not become whole; or
//! standard output.

use crate::record::file::reader::Damage;
use crate::system::SystemError;
use parquet::errors::ParquetError;
use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, BufWriter, Write};
#[cfg(unix)]
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

/// Why nothing was exported.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// Something has that name.
    #[error("{} is already there and is not overwritten", .path.display())]
    Exists { path: PathBuf },
    /// The system does not let it be written.
    #[error("cannot write {}: {error}", .path.display())]
    Unwritable { path: PathBuf, error: SystemError },
    /// The recording cannot be read on.
    #[error("cannot read the recording to its end: {error}")]
    Unreadable { error: SystemError },
    /// There is nothing of this kind in the stretch.
    #[error("there is nothing to export in this stretch")]
    Empty,
    /// Episodes begin at notes, and there is none.
    #[error("there is no note of a person in this stretch, at which an episode could begin")]
    NoNotes,
    /// A left and a right hand in one data set.
    #[error(
        "a left and a right hand cannot be in one data set, because their joints have other names"
    )]
    BothSides,
    /// The user broke it off.
    #[error("interrupted")]
    Interrupted,
    /// Whoever read standard output does not read on.
    #[error("the reader of the output went away")]
    ReaderGone,
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Exported {
    /// Rows of a table, or messages.
    pub rows: u64,
    /// Readings of the hand among the messages; `None` in a table, where each row is one.
    pub readings: Option<u64>,
    /// What of the recording could not be read and is not in it.
    pub damage: Damage,
}

/// Where an export goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Destination {
    /// A file or folder, which must not exist yet.
    Path(PathBuf),
    /// Standard output.
    Stdout,
}

impl From<&Path> for Destination {
    fn from(path: &Path) -> Self {
        Self::Path(path.to_owned())
    }
}

/// What takes the bytes of an export.
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

/// Something that is being written.
#[derive(Debug)]
pub(crate) struct Unfinished {
    wanted: Destination,
    beside: PathBuf,
}

impl Unfinished {
    /// For this place, which must be free.
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

    /// What the system said of writing it.
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

    /// The same of a table, whose errors wrap the system's.
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

    /// The file, in its temporary place. As the recording that it is made of, only its user can read it.
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

    /// The folder, in its temporary place.
    pub(crate) fn folder(&self) -> Result<&Path, ExportError> {
        let mut folder = DirBuilder::new();
        #[cfg(unix)]
        folder.mode(0o700);
        let made = folder.create(&self.beside);
        made.map_err(|error| self.error(&error))?;
        Ok(&self.beside)
    }

    /// A file that is written in full goes to the disk.
    pub(crate) fn sync(&self, mut file: BufWriter<Sink>) -> Result<(), ExportError> {
        let synced = file.flush().and_then(|()| match file.get_ref() {
            Sink::File(file) => file.sync_all(),
            Sink::Stdout(_) => Ok(()),
        });
        synced.map_err(|error| self.error(&error))
    }

    /// Takes the place, unless it has no rows.
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
        // One that took its place is not here any more; what cannot be removed stays beside, under a name that tells.
        let _gone = if self.beside.is_dir() {
            fs::remove_dir_all(&self.beside)
        } else {
            fs::remove_file(&self.beside)
        };
    }
}

/// A folder of several exports, which takes its place only when it is whole.
#[derive(Debug)]
pub struct Folder(Unfinished);

impl Folder {
    /// For this place, which must be free.
    ///
    /// # Errors
    /// [`ExportError`].
    pub fn new(wanted: &Path) -> Result<Self, ExportError> {
        let folder = Unfinished::new(&Destination::from(wanted))?;
        folder.folder()?;
        Ok(Self(folder))
    }

    /// Where it is until it is whole.
    pub fn path(&self) -> &Path {
        &self.0.beside
    }

    /// Takes the place.
    ///
    /// # Errors
    /// [`ExportError`]; then there is no folder.
    pub fn finish(self, rows: u64) -> Result<(), ExportError> {
        self.0.finish(rows)
    }
}
