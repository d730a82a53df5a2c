//! Where session files are put: the system's disk, or one that fails on purpose.

use std::fs::{File, OpenOptions};
use std::io::{self, Seek as _, SeekFrom, Write as _};
use std::path::Path;

/// A place for files.
pub trait Disk: Send + Sync {
    /// Makes a new file, and the folders it needs.
    ///
    /// # Errors
    /// What the system says; `AlreadyExists` if something has that name.
    fn create(&self, path: &Path) -> io::Result<Box<dyn DiskFile>>;

    /// True unless it is certain that nothing has that name any more.
    fn is_there(&self, path: &Path) -> bool;

    /// Removes a file into which nothing could be written.
    ///
    /// # Errors
    /// What the system says.
    fn remove(&self, path: &Path) -> io::Result<()>;
}

/// An open file.
pub trait DiskFile: Send {
    /// Writes all of these bytes at this place. After an error any part of them may have been written.
    ///
    /// # Errors
    /// What the system says.
    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()>;

    /// Waits until what was written would survive a loss of power.
    ///
    /// # Errors
    /// What the system says.
    fn sync(&mut self) -> io::Result<()>;
}

/// The system's disk.
#[derive(Debug, Clone, Copy)]
pub struct SystemDisk;

impl Disk for SystemDisk {
    fn create(&self, path: &Path) -> io::Result<Box<dyn DiskFile>> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        Ok(Box::new(file))
    }

    fn is_there(&self, path: &Path) -> bool {
        path.try_exists().unwrap_or(true)
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
}
