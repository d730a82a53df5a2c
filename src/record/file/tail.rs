//! The end of a file being written: bytes waiting for the disk, and written bytes that may still be lost.

use crate::record::file::disk::{Disk, DiskFile, FilePlace};
use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Interval of syncs, against a loss of power.
pub(crate) const SYNC_INTERVAL: Duration = Duration::from_millis(700);
/// Retry delay of a failed disk.
pub(crate) const RETRY_DELAY: Duration = Duration::from_millis(500);
/// Time after which an open file that accepts nothing, on a disk that is not full, counts as dead: the medium was unplugged.
pub(crate) const DEAD_TIMEOUT: Duration = Duration::from_secs(10);
/// Maximum number of files with one name in one folder; beyond that the folder is faulty.
const NAMES_MAX: u32 = 100;

/// Number of entries in some bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Content {
    pub(crate) entries: u64,
    /// Number of entries that they report as missing.
    pub(crate) reported: u64,
}

impl Content {
    pub(crate) const fn add(&mut self, other: Self) {
        self.entries += other.entries;
        self.reported += other.reported;
    }

    const fn subtract(&mut self, other: Self) {
        self.entries -= other.entries;
        self.reported -= other.reported;
    }
}

#[derive(Debug)]
struct Portion {
    bytes: Vec<u8>,
    content: Content,
}

/// The end of one file.
pub(crate) struct FileTail {
    disk: Arc<dyn Disk>,
    asked: PathBuf,
    /// Number appended to the name; 1 means the plain name.
    number: u32,
    path: Option<PathBuf>,
    /// True if the file was renamed, but its new name is unknown.
    is_lost: bool,
    file: Option<Box<dyn DiskFile>>,
    /// Bytes accepted by the system.
    written: u64,
    /// Content of the written bytes.
    content: Content,
    pending: VecDeque<Portion>,
    /// Written since the last successful sync. If a sync fails, any of it may be lost.
    unsynced: VecDeque<Portion>,
    /// Bytes in both queues.
    held: usize,
    synced_at: Duration,
    retry_at: Option<Duration>,
    fails_since: Option<Duration>,
    failure: Option<io::Error>,
}

impl FileTail {
    /// For a file that is created at the first write; if its name is in use, a number is appended.
    pub(crate) fn new(disk: Arc<dyn Disk>, asked: PathBuf) -> Self {
        Self {
            disk,
            asked,
            number: 1,
            path: None,
            is_lost: false,
            file: None,
            written: 0,
            content: Content::default(),
            pending: VecDeque::new(),
            unsynced: VecDeque::new(),
            held: 0,
            synced_at: Duration::ZERO,
            retry_at: None,
            fails_since: None,
            failure: None,
        }
    }

    /// Another file in its place, with the same name.
    pub(crate) fn again(&self) -> Self {
        Self {
            number: self.number,
            ..Self::new(Arc::clone(&self.disk), self.asked.clone())
        }
    }

    /// Another file beside it, with the next number.
    pub(crate) fn next(&self) -> Self {
        Self {
            number: self.number + u32::from(self.path.is_some()),
            ..self.again()
        }
    }

    /// Its name, which is preliminary until the file is created.
    pub(crate) fn name(&self) -> String {
        let path = self.path.clone();
        let path = path.unwrap_or_else(|| numbered(&self.asked, self.number));
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    pub(crate) fn add(&mut self, mut bytes: Vec<u8>, content: Content) {
        bytes.shrink_to_fit();
        self.held += bytes.len();
        self.pending.push_back(Portion { bytes, content });
    }

    pub(crate) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    pub(crate) const fn written(&self) -> u64 {
        self.written
    }

    /// Bytes in memory.
    pub(crate) const fn held(&self) -> usize {
        self.held
    }

    /// Reason why nothing can be written now, in the system's words.
    pub(crate) fn trouble(&self) -> Option<String> {
        self.failure.as_ref().map(ToString::to_string)
    }

    /// True if everything is written and synced.
    pub(crate) fn is_done(&self) -> bool {
        self.pending.is_empty() && self.unsynced.is_empty()
    }

    /// Checks the place of the file; a move is returned only once.
    pub(crate) fn check_place(&mut self) -> FilePlace {
        let (Some(path), Some(file)) = (&self.path, &self.file) else {
            return FilePlace::There;
        };
        let place = file.place(path);
        match &place {
            FilePlace::Moved(Some(to)) => {
                self.path = Some(to.clone());
                self.is_lost = false;
            }
            FilePlace::Moved(None) if std::mem::replace(&mut self.is_lost, true) => {
                return FilePlace::There;
            }
            _ => {}
        }
        place
    }

    /// True if the file has failed long enough that another one should be tried. A full disk does not count.
    pub(crate) fn is_dead(&self, now: Duration) -> bool {
        let is_full = self.failure.as_ref().is_some_and(|error| {
            matches!(
                error.kind(),
                ErrorKind::StorageFull | ErrorKind::QuotaExceeded
            )
        });
        let since = self.fails_since.filter(|_| self.file.is_some());
        since.is_some_and(|since| !is_full && now.saturating_sub(since) >= DEAD_TIMEOUT)
    }

    /// Restarts the timeout of [`Self::is_dead`].
    pub(crate) const fn spare(&mut self, now: Duration) {
        self.fails_since = Some(now);
    }

    /// Content waiting for the disk.
    pub(crate) fn waiting(&self) -> Content {
        let mut all = Content::default();
        self.pending
            .iter()
            .for_each(|portion| all.add(portion.content));
        all
    }

    /// All content passed to this file.
    pub(crate) fn everything(&self) -> Content {
        let mut all = self.waiting();
        all.add(self.content);
        all
    }

    /// Removes a file into which nothing could be written.
    pub(crate) fn discard(self) {
        let disk = Arc::clone(&self.disk);
        let path = self.path.clone();
        drop(self);
        // A file that cannot be removed remains empty and does no harm.
        let _removed = path.map(|path| disk.remove(&path));
    }

    /// Writes the waiting bytes. Failed writes are retried later at the same offset.
    pub(crate) fn put(&mut self, now: Duration) {
        if self.retry_at.is_some_and(|at| now < at) {
            return;
        }
        let is_due = now.saturating_sub(self.synced_at) >= SYNC_INTERVAL;
        self.attempt(now, is_due);
    }

    /// Writes the waiting bytes without delay, and syncs.
    pub(crate) fn put_safely(&mut self, now: Duration) {
        self.attempt(now, true);
    }

    fn attempt(&mut self, now: Duration, syncs: bool) {
        let result = self
            .write()
            .and_then(|()| if syncs { self.sync(now) } else { Ok(()) });
        self.retry_at = result.is_err().then(|| now + RETRY_DELAY);
        self.fails_since = match result {
            Ok(()) => None,
            Err(_) => self.fails_since.or(Some(now)),
        };
        self.failure = result.err();
    }

    fn write(&mut self) -> io::Result<()> {
        if self.pending.is_empty() {
            return Ok(());
        }
        if self.file.is_none() {
            let (file, number) = create(self.disk.as_ref(), &self.asked, self.number)?;
            self.path = Some(numbered(&self.asked, number));
            (self.file, self.number) = (Some(file), number);
        }
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        while let Some(portion) = self.pending.front() {
            file.write_at(self.written, &portion.bytes)?;
            self.written += length(portion);
            self.content.add(portion.content);
            self.unsynced.extend(self.pending.pop_front());
        }
        Ok(())
    }

    fn sync(&mut self, now: Duration) -> io::Result<()> {
        self.synced_at = now;
        let Some(file) = self.file.as_mut().filter(|_| !self.unsynced.is_empty()) else {
            return Ok(());
        };
        match file.sync() {
            Err(error) if !is_unknown(&error) => {
                // The system reports this only once, and may have discarded the data that it could not write.
                self.rewind();
                Err(error)
            }
            _ => {
                self.unsynced.clear();
                self.held = self.pending.iter().map(|portion| portion.bytes.len()).sum();
                Ok(())
            }
        }
    }

    fn rewind(&mut self) {
        while let Some(portion) = self.unsynced.pop_back() {
            self.written -= length(&portion);
            self.content.subtract(portion.content);
            self.pending.push_front(portion);
        }
    }
}

fn length(portion: &Portion) -> u64 {
    u64::try_from(portion.bytes.len()).unwrap_or_default()
}

/// True if the file system does not support sync.
fn is_unknown(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::Unsupported | ErrorKind::InvalidInput
    )
}

/// The path with a number appended to its name.
fn numbered(asked: &Path, number: u32) -> PathBuf {
    let stem = asked.file_stem().unwrap_or_default().to_string_lossy();
    match number {
        0 | 1 => asked.to_owned(),
        number => asked.with_file_name(format!("{stem}-{number}.mcap")),
    }
}

/// Creates a file with this or the next free number; returns it with its number.
fn create(disk: &dyn Disk, asked: &Path, from: u32) -> io::Result<(Box<dyn DiskFile>, u32)> {
    let mut last = io::Error::from(ErrorKind::AlreadyExists);
    for number in from..from.saturating_add(NAMES_MAX) {
        match disk.create(&numbered(asked, number)) {
            Ok(file) => return Ok((file, number)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => last = error,
            Err(error) => return Err(error),
        }
    }
    Err(last)
}
