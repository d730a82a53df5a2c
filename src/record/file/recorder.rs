//! Writes a recording to disk from a thread of its own, without blocking callers: entries that it cannot accept are counted, and
//! the file records the loss.

use crate::record::Entry;
use crate::record::file::recording::{
    END_TIMEOUT, FLUSH_INTERVAL, Now, QueuedEntry, RecorderStatus, RecordingPlan, RecordingTask,
};
use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

/// Maximum number of queued entries: 20 seconds of one hand, to bridge a stalled disk; about 10 MB.
pub const QUEUE_MAX: usize = 16_384;
/// Interval at which entries are dequeued.
const BATCH: Duration = Duration::from_millis(20);
/// Retry delay of a failed disk while the recording ends.
const END_RETRY: Duration = Duration::from_millis(50);

/// Input of a recording. Clones feed the same recording.
#[derive(Debug, Clone)]
pub struct RecorderInput {
    sender: SyncSender<QueuedEntry>,
    /// Entries lost since the last accepted one.
    lost: Arc<AtomicU64>,
}

impl RecorderInput {
    pub fn new(room: usize) -> (Self, Receiver<QueuedEntry>) {
        let (sender, queue) = sync_channel(room);
        let lost = Arc::new(AtomicU64::new(0));
        (Self { sender, lost }, queue)
    }

    /// Queues an entry. If the queue is full, the entry is counted as lost.
    pub fn push(&self, entry: Entry) {
        let lost_before = self.take_lost();
        let queued = QueuedEntry {
            entry,
            lost_before,
            _taken: None,
        };
        if let Err(TrySendError::Full(_)) = self.sender.try_send(queued) {
            self.missed(lost_before + 1);
        }
    }

    /// Queues an entry and waits until the recorder has processed it and all before it, however busy the computer is.
    pub fn push_in_step(&self, entry: Entry) {
        let (open, processed) = sync_channel(0);
        let queued = QueuedEntry {
            entry,
            lost_before: self.take_lost(),
            _taken: Some(open),
        };
        if self.sender.send(queued).is_ok() {
            // Nothing is sent: this ends when the other end is dropped, with the entry or with the recorder.
            let _closed = processed.recv();
        }
    }

    /// Counts entries that were lost before they got here.
    pub fn missed(&self, entries: u64) {
        self.lost.fetch_add(entries, Ordering::Relaxed);
    }

    /// Returns and resets the number of lost entries.
    pub fn take_lost(&self) -> u64 {
        match self.lost.load(Ordering::Relaxed) {
            0 => 0,
            _ => self.lost.swap(0, Ordering::Relaxed),
        }
    }
}

/// A recording. Dropping it ends the recording, without waiting for the disk.
#[derive(Debug)]
pub struct Recorder {
    input: RecorderInput,
    status: Arc<Mutex<RecorderStatus>>,
    ends: Arc<AtomicBool>,
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Release);
    }
}

impl Recorder {
    /// Starts a recording.
    ///
    /// # Errors
    /// The system's error if it cannot start a thread. A failing disk is not an error here: it is retried and shown in the
    /// status.
    pub fn start(plan: RecordingPlan) -> io::Result<Self> {
        let (input, queue) = RecorderInput::new(QUEUE_MAX);
        let began = Instant::now();
        let recording = RecordingTask::new(plan, now(began));
        let recorder = Self {
            input: input.clone(),
            status: Arc::new(Mutex::new(RecorderStatus::default())),
            ends: Arc::new(AtomicBool::new(false)),
        };
        let worker = RecorderThread {
            recording: recording.map_err(io::Error::other)?,
            queue,
            lost: input.lost,
            status: Arc::clone(&recorder.status),
            ends: Arc::clone(&recorder.ends),
            began,
        };
        let thread = std::thread::Builder::new().name("recorder".into());
        let _detached = thread.spawn(move || worker.run())?;
        Ok(recorder)
    }

    pub fn input(&self) -> RecorderInput {
        self.input.clone()
    }

    /// Current status, including entries lost in the queue.
    pub fn status(&self) -> RecorderStatus {
        let status = self.status.lock().unwrap_or_else(PoisonError::into_inner);
        let mut status = status.clone();
        status.missing += self.input.lost.load(Ordering::Relaxed);
        status
    }

    /// Ends the recording and waits for that, at most a few seconds.
    pub fn end(self) -> RecorderStatus {
        self.ends.store(true, Ordering::Release);
        let until = Instant::now() + END_TIMEOUT + Duration::from_millis(500);
        loop {
            let status = self.status();
            if status.ended || Instant::now() >= until {
                return status;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

fn now(began: Instant) -> Now {
    let since_1970 = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let nanos = |time: Duration| i64::try_from(time.as_nanos()).unwrap_or(i64::MAX);
    Now {
        since: began.elapsed(),
        wall_nanos: match since_1970 {
            Ok(after) => nanos(after),
            Err(before) => -nanos(before.duration()),
        },
    }
}

/// Work of the thread: it dequeues entries, and runs the recording's due steps.
struct RecorderThread {
    recording: RecordingTask,
    queue: Receiver<QueuedEntry>,
    lost: Arc<AtomicU64>,
    status: Arc<Mutex<RecorderStatus>>,
    ends: Arc<AtomicBool>,
    began: Instant,
}

impl RecorderThread {
    fn run(mut self) {
        let mut ends = false;
        while !ends {
            match self.queue.recv_timeout(FLUSH_INTERVAL / 2) {
                Ok(queued) => {
                    self.recording.accept(&queued);
                    // Waking up for each entry would cost as much as the work itself.
                    std::thread::sleep(BATCH);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => ends = true,
            }
            // Entries queued before the request to end belong to the recording.
            ends |= self.ends.load(Ordering::Acquire);
            for _ in 0..QUEUE_MAX {
                let Ok(queued) = self.queue.try_recv() else {
                    break;
                };
                self.recording.accept(&queued);
            }
            self.recording.step(now(self.began));
            self.publish_status();
        }
        self.recording.lose(self.lost.swap(0, Ordering::Relaxed));
        self.recording.end(now(self.began));
        while !self.recording.end_step(self.began.elapsed()) {
            self.publish_status();
            std::thread::sleep(END_RETRY);
        }
        self.publish_status();
    }

    fn publish_status(&self) {
        let status = self.recording.status(self.began.elapsed());
        *self.status.lock().unwrap_or_else(PoisonError::into_inner) = status;
    }
}
