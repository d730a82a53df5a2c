//! Writes standard output and standard error, each on a thread with a bounded queue: a slow or stuck reader delays neither the
//! hand nor its stop.

use std::io::{self, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum bytes queued for a stream: seconds of samples at full rate. Further lines are dropped and counted.
pub(crate) const STREAM_MAX: usize = 1024 * 1024;
/// Maximum bytes queued, results included: many times the longest report.
pub(crate) const QUEUE_MAX: usize = 8 * STREAM_MAX;
/// Bytes per write: a pipe accepts them at once or not at all, so that every read of a slow reader counts as progress.
const CHUNK: usize = 4096;
/// Delay before a retry if the output is not ready.
const RETRY_DELAY: Duration = Duration::from_millis(5);
/// Longest wait before [`LineWriter::drained`] calls its callback again.
const ASK_INTERVAL: Duration = Duration::from_millis(50);

/// Importance of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LineClass {
    /// One of many of the same kind: it may be dropped.
    Stream,
    /// An answer, a message or a report.
    Result,
}

/// Reason why nothing is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum OutputError {
    /// The output cannot be written, or its reader closed it.
    #[error("{0}")]
    Io(io::ErrorKind),
    /// The queue is full.
    #[error("{QUEUE_MAX} bytes wait to be read")]
    Full,
}

/// A writing thread, and its queue.
pub(crate) struct LineWriter(Arc<SharedQueue>);

#[derive(Default)]
struct SharedQueue {
    queue: Mutex<Queue>,
    changed: Condvar,
}

#[derive(Default)]
struct Queue {
    bytes: Vec<u8>,
    /// Bytes queued or being written.
    waiting: usize,
    written: u64,
    end: Option<io::ErrorKind>,
    /// True if nothing more will be queued: the thread ends once all is written.
    closed: bool,
}

impl LineWriter {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub(crate) fn start(name: &str, to: impl Write + Send + 'static) -> io::Result<Self> {
        let writer = Self(Arc::default());
        let shared = Arc::clone(&writer.0);
        let thread = std::thread::Builder::new().name(name.to_owned());
        thread.spawn(move || shared.write(to))?;
        Ok(writer)
    }

    /// Queues whole lines. Returns false if there is no room: a stream drops them, a result is retried or fails.
    pub(crate) fn push(&self, lines: &[u8], class: LineClass) -> Result<bool, OutputError> {
        let mut queue = self.0.lock();
        if let Some(end) = queue.end {
            return Err(OutputError::Io(end));
        }
        let limit = match class {
            LineClass::Stream => STREAM_MAX,
            LineClass::Result => QUEUE_MAX,
        };
        // A line longer than the limit is accepted if the queue is empty.
        if queue.waiting > 0 && queue.waiting + lines.len() > limit {
            return Ok(false);
        }
        queue.bytes.extend_from_slice(lines);
        queue.waiting += lines.len();
        drop(queue);
        self.0.changed.notify_all();
        Ok(true)
    }

    /// Waits for room, or the end of the output. Must not be called on a thread that runs links.
    pub(crate) fn wait_for_room(&self) {
        let half = |queue: &mut Queue| queue.end.is_none() && queue.waiting > QUEUE_MAX / 2;
        let waited = self.0.changed.wait_while(self.0.lock(), half);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }

    /// Number of bytes queued, and of bytes written so far.
    pub(crate) fn progress(&self) -> (usize, u64) {
        let queue = self.0.lock();
        (queue.waiting, queue.written)
    }

    /// Returns the error if the output has ended.
    pub(crate) fn check(&self) -> Result<(), OutputError> {
        self.0
            .lock()
            .end
            .map_or(Ok(()), |end| Err(OutputError::Io(end)))
    }

    /// Waits until all is written, or `waits_on`, given the time without progress, returns false. Returns the number of
    /// bytes left.
    pub(crate) fn drained(
        &self,
        mut waits_on: impl FnMut(Duration) -> bool,
    ) -> Result<usize, OutputError> {
        let mut queue = self.0.lock();
        let mut progress = (queue.written, Instant::now());
        while queue.waiting > 0 && queue.end.is_none() {
            if queue.written != progress.0 {
                progress = (queue.written, Instant::now());
            }
            let left = queue.waiting;
            drop(queue);
            if !waits_on(progress.1.elapsed()) {
                return Ok(left);
            }
            let waited = self.0.changed.wait_timeout(self.0.lock(), ASK_INTERVAL);
            queue = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        queue.end.map_or(Ok(0), |end| Err(OutputError::Io(end)))
    }
}

impl Drop for LineWriter {
    fn drop(&mut self) {
        self.0.lock().closed = true;
        self.0.changed.notify_all();
    }
}

impl SharedQueue {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs the thread: writes the queue until it is closed, or writing fails.
    fn write(&self, mut to: impl Write) {
        loop {
            let empty = |queue: &mut Queue| queue.bytes.is_empty() && !queue.closed;
            let waited = self.changed.wait_while(self.lock(), empty);
            let mut queue = waited.unwrap_or_else(PoisonError::into_inner);
            let bytes = std::mem::take(&mut queue.bytes);
            drop(queue);
            if bytes.is_empty() {
                return;
            }
            if let Err(error) = self.write_all(&mut to, &bytes) {
                let mut queue = self.lock();
                queue.end = Some(error.kind());
                queue.bytes = Vec::new();
                drop(queue);
                self.changed.notify_all();
                return;
            }
        }
    }

    fn write_all(&self, to: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
        for chunk in bytes.chunks(CHUNK) {
            let mut rest = chunk;
            while !rest.is_empty() {
                match insist(|| to.write(rest))? {
                    0 => return Err(io::ErrorKind::WriteZero.into()),
                    len => rest = rest.get(len..).unwrap_or_default(),
                }
            }
            insist(|| to.flush())?;
            let mut queue = self.lock();
            queue.waiting = queue.waiting.saturating_sub(chunk.len());
            queue.written = queue
                .written
                .saturating_add(u64::try_from(chunk.len()).unwrap_or(u64::MAX));
            drop(queue);
            self.changed.notify_all();
        }
        Ok(())
    }
}

/// Retries after a signal, or if the output is not ready: another program that shares it may have made it non-blocking.
fn insist<T>(mut write: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    loop {
        match write() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                std::thread::sleep(RETRY_DELAY);
            }
            done => return done,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    /// Accepts as many bytes as the test permits, and reports them.
    struct Pipe {
        room: mpsc::Receiver<usize>,
        taken: mpsc::Sender<Vec<u8>>,
    }

    impl Write for Pipe {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let room = self
                .room
                .recv()
                .map_err(|_closed| io::ErrorKind::BrokenPipe)?;
            if room == 0 {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            let len = room.min(bytes.len());
            self.taken.send(bytes[..len].to_vec()).unwrap();
            Ok(len)
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn piped() -> (LineWriter, mpsc::Sender<usize>, mpsc::Receiver<Vec<u8>>) {
        let (read, room) = mpsc::channel();
        let (taken, seen) = mpsc::channel();
        let writer = LineWriter::start("test", Pipe { room, taken }).unwrap();
        (writer, read, seen)
    }

    #[test]
    fn a_reader_that_does_not_read_costs_stream_lines_and_no_result() {
        let (writer, _read, _seen) = piped();
        let line = [b'x'; 64 * 1024];
        let taken = (0..100).filter(|_| writer.push(&line, LineClass::Stream).unwrap());
        assert_eq!(taken.count(), STREAM_MAX / line.len());
        assert_eq!(writer.push(b"result\n", LineClass::Result), Ok(true));
        let results = (0..1000).filter(|_| writer.push(&line, LineClass::Result).unwrap());
        assert_eq!(results.count(), (QUEUE_MAX - STREAM_MAX) / line.len() - 1);
        let left = writer.drained(|stalled| stalled < ASK_INTERVAL);
        assert!(left.unwrap() > QUEUE_MAX - 2 * line.len());
    }

    #[test]
    fn a_slow_reader_gets_everything_in_order() {
        let (writer, read, seen) = piped();
        writer.push(b"one\n", LineClass::Stream).unwrap();
        writer.push(b"two\n", LineClass::Result).unwrap();
        let slow = std::thread::spawn(move || {
            let sizes = [0, 1, 0, 2, 3, 0, 1, 1, 9];
            sizes
                .into_iter()
                .take_while(|size| read.send(*size).is_ok())
                .count()
        });
        assert_eq!(writer.drained(|_| true), Ok(0));
        slow.join().unwrap();
        assert_eq!(seen.try_iter().flatten().collect::<Vec<_>>(), b"one\ntwo\n");
        assert_eq!(writer.progress(), (0, 8));
    }

    #[test]
    fn a_closed_reader_ends_the_output() {
        let (writer, read, _seen) = piped();
        drop(read);
        writer.push(b"one\n", LineClass::Result).unwrap();
        let broken = Err(OutputError::Io(io::ErrorKind::BrokenPipe));
        assert_eq!(writer.drained(|_| true).map(|_| ()), broken);
        assert_eq!(writer.check(), broken);
        assert_eq!(writer.push(b"two\n", LineClass::Stream).map(|_| ()), broken);
    }

    #[test]
    fn the_wait_for_a_reader_ends_when_it_is_told_to() {
        let (writer, _read, _seen) = piped();
        writer.push(b"one\n", LineClass::Result).unwrap();
        let mut asked = 0;
        let left = writer.drained(|_| {
            asked += 1;
            asked < 3
        });
        assert_eq!(left, Ok(4));
    }
}
