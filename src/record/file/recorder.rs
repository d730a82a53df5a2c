//! Puts a session on the disk from a thread of its own. Nobody waits for it: what it cannot take is counted, and said in the file.

use crate::record::file::disk::{Disk, DiskFile};
use crate::record::file::opening::Opening;
use crate::record::file::writer::SessionWriter;
use crate::record::{Entry, Event, EventKind};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

/// Entries that may wait for the thread: five seconds, in which a slow disk stalls, at 3000 a second; about 10 MB.
pub const QUEUE_MAX: usize = 16_384;
/// Bytes that may wait for the disk: two minutes and more of one hand.
pub const PENDING_MAX: usize = 16 * 1024 * 1024;
/// What was taken goes to the file at least this often, so that a killed program loses no more than a quarter of a second.
pub const FLUSH_EACH: Duration = Duration::from_millis(125);
/// Entries are taken this often.
const BATCH: Duration = Duration::from_millis(20);
/// Against a loss of power.
pub const SYNC_EACH: Duration = Duration::from_millis(700);
/// A disk that failed is tried again after this.
const RETRY_AFTER: Duration = Duration::from_millis(500);
/// How often it is looked whether the file is still there and the computer's clock was set.
const LOOK_EACH: Duration = Duration::from_secs(1);
/// A clock that differs by more was set, or the computer slept.
const CLOCK_SET: Duration = Duration::from_secs(1);
/// A file that cannot be ended in this time is left as it is; a reader can do without its end.
const END_WITHIN: Duration = Duration::from_secs(2);
/// Files of one second in one folder; beyond that something is wrong with the folder.
const NAMES_MAX: u32 = 100;

/// Where a session goes.
#[derive(Clone)]
pub struct RecordingPlan {
    /// The file, which must not be there yet, else a number is put to its name.
    pub path: PathBuf,
    /// What the file begins with.
    pub opening: Opening,
    /// Where it lies.
    pub disk: Arc<dyn Disk>,
}

/// How a recording goes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RecorderStatus {
    /// The file; `None` before there is one.
    pub path: Option<PathBuf>,
    /// Bytes that the system took.
    pub bytes: u64,
    /// Bytes of earlier files of the same recording.
    pub earlier_bytes: u64,
    /// Entries taken.
    pub entries: u64,
    /// Entries that could not be taken.
    pub missing: u64,
    /// Why nothing can be written now, in the system's words.
    pub trouble: Option<String>,
    /// Since when it records.
    pub since: Duration,
    /// The file is ended.
    pub ended: bool,
}

impl RecorderStatus {
    /// Megabytes an hour, once there is enough to tell.
    #[must_use]
    pub fn megabytes_an_hour(&self) -> Option<f64> {
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53 bytes")]
        let bytes = (self.bytes + self.earlier_bytes) as f64;
        let seconds = self.since.as_secs_f64();
        (seconds >= 5.0).then(|| bytes / seconds * 3600.0 / 1e6)
    }
}

enum Job {
    Entry(Box<Entry>),
    End,
}

/// What entries are given to. Copies give to the same recording.
#[derive(Debug, Clone)]
pub struct RecorderInput {
    jobs: SyncSender<Job>,
    missing: Arc<AtomicU64>,
}

impl RecorderInput {
    /// Gives an entry. One that finds no room is counted.
    pub fn push(&self, entry: Entry) {
        if let Err(TrySendError::Full(_)) = self.jobs.try_send(Job::Entry(Box::new(entry))) {
            self.missing.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Counts entries that were lost on the way here.
    pub fn missed(&self, entries: u64) {
        self.missing.fetch_add(entries, Ordering::Relaxed);
    }
}

/// A recording. It ends when this is dropped, without waiting for the disk.
#[derive(Debug)]
pub struct Recorder {
    input: RecorderInput,
    status: Arc<Mutex<RecorderStatus>>,
}

impl Drop for Recorder {
    fn drop(&mut self) {
        // A full queue is read on to its end when all inputs are gone.
        let _ends = self.input.jobs.try_send(Job::End);
    }
}

impl Recorder {
    /// Begins a recording.
    ///
    /// # Errors
    /// What the system says if it gives no thread. A disk that fails is no error here: it is tried again and told.
    pub fn start(plan: RecordingPlan) -> io::Result<Self> {
        let (jobs, taken) = sync_channel(QUEUE_MAX);
        let missing = Arc::new(AtomicU64::new(0));
        let status = Arc::new(Mutex::new(RecorderStatus::default()));
        let writer = SessionWriter::new(&plan.opening).map_err(io::Error::other)?;
        let work = Work {
            writer,
            tail: Tail::new(Arc::clone(&plan.disk), plan.path.clone()),
            opening: plan.opening,
            missing: Arc::clone(&missing),
            told_missing: 0,
            status: Arc::clone(&status),
            taken: 0,
            earlier_bytes: 0,
            clock: WallClock::start(),
            began: Instant::now(),
        };
        let thread = std::thread::Builder::new().name("recorder".into());
        let _detached = thread.spawn(move || work.run(&taken))?;
        Ok(Self {
            input: RecorderInput { jobs, missing },
            status,
        })
    }

    /// Where entries are given to.
    #[must_use]
    pub fn input(&self) -> RecorderInput {
        self.input.clone()
    }

    /// How it goes.
    #[must_use]
    pub fn status(&self) -> RecorderStatus {
        let status = self.status.lock().unwrap_or_else(PoisonError::into_inner);
        status.clone()
    }

    /// Ends the file and waits for that, at most a few seconds.
    #[must_use]
    pub fn end(self) -> RecorderStatus {
        let (input, status) = (self.input.clone(), Arc::clone(&self.status));
        drop(self);
        let until = Instant::now() + END_WITHIN + Duration::from_millis(500);
        let mut asked = false;
        loop {
            let now = status
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .clone();
            if now.ended || Instant::now() >= until {
                return now;
            }
            asked = asked || input.jobs.try_send(Job::End).is_ok();
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

struct Work {
    writer: SessionWriter,
    tail: Tail,
    opening: Opening,
    missing: Arc<AtomicU64>,
    told_missing: u64,
    status: Arc<Mutex<RecorderStatus>>,
    taken: u64,
    earlier_bytes: u64,
    clock: WallClock,
    began: Instant,
}

impl Work {
    fn run(mut self, jobs: &Receiver<Job>) {
        let (mut flushed, mut looked) = (Instant::now(), Instant::now());
        loop {
            let ends = match jobs.recv_timeout(FLUSH_EACH / 2) {
                Ok(Job::Entry(entry)) => {
                    self.take(&entry);
                    // Woken for each entry, the thread would cost as much as the work it does.
                    std::thread::sleep(BATCH);
                    self.drain(jobs)
                }
                Ok(Job::End) | Err(RecvTimeoutError::Disconnected) => true,
                Err(RecvTimeoutError::Timeout) => false,
            };
            if flushed.elapsed() >= FLUSH_EACH || ends {
                flushed = Instant::now();
                self.flush();
            }
            if looked.elapsed() >= LOOK_EACH {
                looked = Instant::now();
                self.look();
            }
            if ends {
                self.drain(jobs);
                self.end();
                return;
            }
        }
    }

    /// Takes what waits; true if the end is among it.
    fn drain(&mut self, jobs: &Receiver<Job>) -> bool {
        for _ in 0..QUEUE_MAX {
            match jobs.try_recv() {
                Ok(Job::Entry(entry)) => self.take(&entry),
                Ok(Job::End) => return true,
                Err(_) => return false,
            }
        }
        false
    }

    fn take(&mut self, entry: &Entry) {
        if self.tail.is_full() {
            self.missing.fetch_add(1, Ordering::Relaxed);
            return;
        }
        self.tell_missing(entry);
        self.taken += 1;
        self.push(entry);
    }

    fn push(&mut self, entry: &Entry) {
        if let Err(error) = self.writer.push(entry) {
            self.tail.trouble = Some(error.to_string());
        }
    }

    /// Says in the file that entries are missing here.
    fn tell_missing(&mut self, before: &Entry) {
        let missing = self.missing.load(Ordering::Relaxed);
        if missing > self.told_missing {
            let lost = missing - self.told_missing;
            self.told_missing = missing;
            self.note(before, format!("{lost} entries are missing before this"));
        }
    }

    fn note(&mut self, at: &Entry, words: String) {
        self.push(&Entry::Event(Event {
            at: at.at(),
            kind: EventKind::Recording,
            words,
        }));
    }

    fn flush(&mut self) {
        if let Err(error) = self.writer.flush() {
            self.tail.trouble = Some(error.to_string());
        }
        self.tail.add(self.writer.take_bytes());
        self.tail.put();
        self.tell(false);
    }

    /// Looks whether the file is still there and the clock goes on as before.
    fn look(&mut self) {
        let drift = self.clock.drift();
        if self.tail.is_gone() || drift.is_some() {
            self.next_file(drift.unwrap_or_default());
        }
    }

    /// Goes on in another file: times in it are those of the clock as it is now.
    fn next_file(&mut self, drift_nanos: i64) {
        self.end_file();
        self.earlier_bytes += self.tail.written;
        self.opening.base_nanos = self.opening.base_nanos.saturating_add_signed(drift_nanos);
        if let Ok(writer) = SessionWriter::new(&self.opening) {
            self.writer = writer;
            self.tail = Tail::new(Arc::clone(&self.tail.disk), self.tail.asked.clone());
            self.clock = WallClock::start();
        }
    }

    fn end_file(&mut self) {
        let _whole = self.writer.finish();
        self.tail.add(self.writer.take_bytes());
        let until = Instant::now() + END_WITHIN;
        while !self.tail.pending.is_empty() && Instant::now() < until {
            self.tail.retry_at = None;
            self.tail.put();
            if !self.tail.pending.is_empty() {
                std::thread::sleep(Duration::from_millis(50));
            }
        }
        self.tail.sync_now();
    }

    fn end(mut self) {
        self.end_file();
        self.tell(true);
    }

    fn tell(&self, ended: bool) {
        let mut status = self.status.lock().unwrap_or_else(PoisonError::into_inner);
        *status = RecorderStatus {
            path: self.tail.path.clone(),
            bytes: self.tail.written,
            earlier_bytes: self.earlier_bytes,
            entries: self.taken,
            missing: self.missing.load(Ordering::Relaxed),
            trouble: self.tail.trouble.clone(),
            since: self.began.elapsed(),
            ended,
        };
    }
}

/// The end of the file: bytes that wait for the disk, and where they go.
struct Tail {
    disk: Arc<dyn Disk>,
    asked: PathBuf,
    path: Option<PathBuf>,
    file: Option<Box<dyn DiskFile>>,
    written: u64,
    pending: Vec<u8>,
    unsynced: bool,
    synced: Instant,
    retry_at: Option<Instant>,
    trouble: Option<String>,
}

impl Tail {
    fn new(disk: Arc<dyn Disk>, asked: PathBuf) -> Self {
        Self {
            disk,
            asked,
            path: None,
            file: None,
            written: 0,
            pending: Vec::new(),
            unsynced: false,
            synced: Instant::now(),
            retry_at: None,
            trouble: None,
        }
    }

    fn add(&mut self, bytes: Vec<u8>) {
        self.pending.extend(bytes);
    }

    const fn is_full(&self) -> bool {
        self.pending.len() >= PENDING_MAX
    }

    fn is_gone(&self) -> bool {
        let path = self.path.as_deref();
        path.is_some_and(|path| !self.disk.is_there(path))
    }

    /// Gives the disk what waits. What fails waits on, and is tried again at the same place.
    fn put(&mut self) {
        if self.retry_at.is_some_and(|at| Instant::now() < at) {
            return;
        }
        self.retry_at = None;
        match self.try_put() {
            Ok(()) => self.trouble = None,
            Err(error) => {
                self.trouble = Some(error.to_string());
                self.retry_at = Some(Instant::now() + RETRY_AFTER);
            }
        }
    }

    fn try_put(&mut self) -> io::Result<()> {
        if self.file.is_none() {
            let (file, path) = create(self.disk.as_ref(), &self.asked)?;
            (self.file, self.path) = (Some(file), Some(path));
        }
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        if !self.pending.is_empty() {
            file.write_at(self.written, &self.pending)?;
            self.written += u64::try_from(self.pending.len()).unwrap_or_default();
            self.pending = Vec::new();
            self.unsynced = true;
        }
        if self.unsynced && self.synced.elapsed() >= SYNC_EACH {
            self.synced = Instant::now();
            file.sync()?;
            self.unsynced = false;
        }
        Ok(())
    }

    fn sync_now(&mut self) {
        if let Some(file) = self.file.as_mut().filter(|_| self.unsynced) {
            self.unsynced = file.sync().is_err();
        }
    }
}

/// A new file of this name, or of the name with a number.
fn create(disk: &dyn Disk, asked: &Path) -> io::Result<(Box<dyn DiskFile>, PathBuf)> {
    let stem = asked.file_stem().unwrap_or_default().to_string_lossy();
    let numbered = (2..NAMES_MAX).map(|n| asked.with_file_name(format!("{stem}-{n}.mcap")));
    let mut last = io::Error::from(io::ErrorKind::AlreadyExists);
    for path in std::iter::once(asked.to_owned()).chain(numbered) {
        match disk.create(&path) {
            Ok(file) => return Ok((file, path)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => last = error,
            Err(error) => return Err(error),
        }
    }
    Err(last)
}

/// Notices that the computer's clock was set, or stood while the computer slept.
struct WallClock {
    wall: SystemTime,
    at: Instant,
}

impl WallClock {
    fn start() -> Self {
        Self {
            wall: SystemTime::now(),
            at: Instant::now(),
        }
    }

    /// By how many nanoseconds the clock is ahead of what it should be, if that is much.
    fn drift(&self) -> Option<i64> {
        let should = self.wall + self.at.elapsed();
        let nanos = |apart: Duration| i64::try_from(apart.as_nanos()).unwrap_or(i64::MAX);
        let drift = match SystemTime::now().duration_since(should) {
            Ok(ahead) => nanos(ahead),
            Err(behind) => -nanos(behind.duration()),
        };
        (u128::from(drift.unsigned_abs()) > CLOCK_SET.as_nanos()).then_some(drift)
    }
}
