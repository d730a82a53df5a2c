//! The storage of recording files: the system's disk, or in tests one that fails on purpose.

use std::fs::{DirBuilder, File, OpenOptions};
use std::io::{self, Seek as _, SeekFrom, Write as _};
#[cfg(unix)]
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
#[cfg(windows)]
use std::os::windows::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};

/// Storage for files.
pub trait Disk: Send + Sync {
    /// Creates a new file, and the folders it needs.
    ///
    /// # Errors
    /// The system's error; `AlreadyExists` if the path exists.
    fn create(&self, path: &Path) -> io::Result<Box<dyn DiskFile>>;

    /// Removes a file into which nothing could be written.
    ///
    /// # Errors
    /// The system's error.
    fn remove(&self, path: &Path) -> io::Result<()>;
}

pub trait DiskFile: Send {
    /// Writes all of these bytes at offset `place`. After an error any part of them may have been written.
    ///
    /// # Errors
    /// The system's error.
    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()>;

    /// Waits until the written data would survive a power loss.
    ///
    /// # Errors
    /// The system's error.
    fn sync(&mut self) -> io::Result<()>;

    /// Current place of the file that was created at this path.
    fn place(&self, path: &Path) -> FilePlace;
}

/// Place of an open file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FilePlace {
    /// At its original path, as far as the system reports.
    There,
    /// The file or its folder was renamed; `None` if the system does not report the new path. Writes still reach it.
    Moved(Option<PathBuf>),
    /// It was deleted: all data is lost as soon as it is closed.
    Removed,
}

/// Without delete sharing: Windows refuses to move or remove the file while it is written.
#[cfg(windows)]
const FILE_SHARE_READ_WRITE: u32 = 3;

/// The system's disk. Only the user who records can read the files, or enter the folders created for them.
#[derive(Debug, Clone, Copy)]
pub struct SystemDisk;

impl Disk for SystemDisk {
    fn create(&self, path: &Path) -> io::Result<Box<dyn DiskFile>> {
        if let Some(folder) = path.parent() {
            let mut made = DirBuilder::new();
            made.recursive(true);
            #[cfg(unix)]
            made.mode(0o700);
            made.create(folder)?;
        }
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        options.mode(0o600);
        #[cfg(windows)]
        options.share_mode(FILE_SHARE_READ_WRITE);
        Ok(Box::new(options.open(path)?))
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        std::fs::remove_file(path)
    }
}

impl DiskFile for File {
    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        self.seek(SeekFrom::Start(place))?;
        self.write_all(bytes)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }

    fn place(&self, path: &Path) -> FilePlace {
        place_of(self, path)
    }
}

#[cfg(unix)]
fn place_of(file: &File, path: &Path) -> FilePlace {
    use std::os::{fd::AsRawFd as _, unix::fs::MetadataExt as _};
    let Ok(own) = file.metadata() else {
        return FilePlace::There;
    };
    if own.nlink() == 0 {
        return FilePlace::Removed;
    }
    let is_own = |there: std::fs::Metadata| (there.dev(), there.ino()) == (own.dev(), own.ino());
    match std::fs::metadata(path).map(is_own) {
        Ok(true) => FilePlace::There,
        Err(error) if error.kind() != io::ErrorKind::NotFound => FilePlace::There,
        _ => {
            let link = format!("/proc/self/fd/{}", file.as_raw_fd());
            FilePlace::Moved(std::fs::read_link(link).ok())
        }
    }
}

#[cfg(windows)]
const fn place_of(_file: &File, _path: &Path) -> FilePlace {
    FilePlace::There
}
