//! Standard input and output as lines: a program that does not read delays neither the hand nor its stop. Lines that it does not
//! read in time are dropped and counted.

use crate::cli::out::Out;
use crate::inputs::lines::{LONGEST, LineCutter, LineEvent};
use crate::inputs::scan::unmarked;
use serde_json::Value;
use std::io::{self, BufRead as _};
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::time::Instant;

/// Capacity of the queue of input lines.
const LINES_MAX: usize = 64;
/// A program that reads nothing for this time no longer monitors the hand.
const WRITE_TIMEOUT: Duration = Duration::from_secs(1);

/// Lines of standard input. The channel closes with it. `stop` is called for a stop in an incomplete or overlong line.
pub(crate) fn lines(stop: impl Fn() + Send + 'static) -> mpsc::Receiver<Vec<u8>> {
    let (sender, lines) = mpsc::channel(LINES_MAX);
    std::thread::spawn(move || {
        let mut input = io::stdin().lock();
        let mut cutter = LineCutter::new(LONGEST);
        let hand_on = |cut: LineEvent| match cut {
            LineEvent::Stop => {
                stop();
                true
            }
            LineEvent::Line { text, .. } if unmarked(&text).is_empty() => true,
            LineEvent::Line { text, .. } => sender.blocking_send(text).is_ok(),
        };
        loop {
            let bytes = match input.fill_buf() {
                Ok(bytes) => bytes,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(_closed) => &[],
            };
            let len = bytes.len();
            let cuts = cutter.push(bytes);
            if !cuts.into_iter().all(hand_on) {
                return;
            }
            if len == 0 {
                // Any other incomplete line is ignored.
                cutter.end().into_iter().all(hand_on);
                return;
            }
            input.consume(len);
        }
    });
    lines
}

/// Standard output is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NobodyReads;

/// Standard output.
pub(crate) struct ReplyWriter<'a> {
    out: &'a mut Out,
    /// Bytes read at the last progress, and its time.
    progress: (u64, Instant),
}

impl<'a> ReplyWriter<'a> {
    pub(crate) fn to(out: &'a mut Out) -> Self {
        // At the end the program may be gone; the hand has been stopped by then.
        out.end_without_reader();
        Self {
            out,
            progress: (0, Instant::now()),
        }
    }

    /// Writes a message that must not be lost.
    pub(crate) fn send(&mut self, what: &Value) -> Result<(), NobodyReads> {
        self.out.object(what).map_err(|_full_or_closed| NobodyReads)
    }

    /// Writes a state, or counts it if there is no room.
    pub(crate) fn state(
        &mut self,
        state: impl FnOnce() -> Value,
        missed: u64,
    ) -> Result<(), NobodyReads> {
        self.out.missed(missed);
        let written = self.out.stream_object(&state());
        written.map_err(|_closed| NobodyReads)
    }

    /// True if queued lines have not been read for too long.
    pub(crate) fn is_stuck(&mut self) -> bool {
        let (waiting, read) = self.out.progress();
        if waiting == 0 || read != self.progress.0 {
            self.progress = (read, Instant::now());
        }
        self.progress.1.elapsed() > WRITE_TIMEOUT
    }
}
