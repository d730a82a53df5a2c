//! Standard input and output as lines, each on a thread of its own: a program that does not read holds up neither the hand nor
//! its stop. What it does not read in time is left out and counted.

use anyhow::Context as _;
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, BufRead as _, BufWriter, Read as _, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::sync::mpsc::error::TrySendError;
use tokio::time::Instant;

/// Lines that may wait to be read: a second of states at full rate …
const WAITING_MAX: usize = 1024;
/// … and so many of them are for answers alone.
const FOR_ANSWERS: usize = 256;
/// Longest line that is taken, bytes.
const LINE_MAX: u64 = 64 * 1024;
/// Lines that may wait to be obeyed.
const ASKED_MAX: usize = 64;
/// A program that takes nothing for so long does not look at what the hand does.
const TAKES_WITHIN: Duration = Duration::from_secs(1);

/// Lines of standard input. The channel ends with it.
pub(crate) fn lines() -> mpsc::Receiver<Vec<u8>> {
    let (asked, lines) = mpsc::channel(ASKED_MAX);
    std::thread::spawn(move || {
        let mut input = io::stdin().lock();
        loop {
            let mut line = Vec::new();
            let read = (&mut input).take(LINE_MAX).read_until(b'\n', &mut line);
            // What is no whole line is not obeyed.
            if read.is_err() || line.pop() != Some(b'\n') {
                return;
            }
            if asked.blocking_send(line).is_err() {
                return;
            }
        }
    });
    lines
}

/// Nobody reads standard output any more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NobodyReads;

/// Standard output.
pub(crate) struct Told {
    lines: mpsc::Sender<String>,
    written: Arc<AtomicU64>,
    /// How much was written when it was looked last, and since when no more.
    stood: (u64, Instant),
    /// States that were left out since that was told.
    lost: u64,
}

impl Told {
    /// Must be called within a tokio runtime.
    pub(crate) fn stdout() -> anyhow::Result<Self> {
        let out = own_stdout().context("cannot write to standard output")?;
        let (lines, waiting) = mpsc::channel(WAITING_MAX);
        let written = Arc::new(AtomicU64::new(0));
        let counted = Arc::clone(&written);
        std::thread::spawn(move || write(out, waiting, &counted));
        Ok(Self {
            lines,
            written,
            stood: (0, Instant::now()),
            lost: 0,
        })
    }

    /// Tells something that must not get lost.
    pub(crate) fn tell(&mut self, what: &Value) -> Result<(), NobodyReads> {
        let sent = self.lines.try_send(what.to_string());
        sent.map_err(|_full_or_closed| NobodyReads)
    }

    /// Tells a state, or counts it where there is no room.
    pub(crate) fn state(
        &mut self,
        state: impl FnOnce() -> Value,
        missed: u64,
    ) -> Result<(), NobodyReads> {
        self.lost += missed;
        if self.lines.capacity() <= FOR_ANSWERS {
            self.lost += 1;
            return Ok(());
        }
        if self.lost > 0 {
            self.tell(&json!({"lost": self.lost}))?;
            self.lost = 0;
        }
        match self.lines.try_send(state().to_string()) {
            Ok(()) => Ok(()),
            Err(TrySendError::Full(_)) => {
                self.lost += 1;
                Ok(())
            }
            Err(TrySendError::Closed(_)) => Err(NobodyReads),
        }
    }

    /// Whether lines wait that were not taken for too long.
    pub(crate) fn is_stuck(&mut self) -> bool {
        let written = self.written.load(Ordering::Relaxed);
        let waits = self.lines.capacity() < self.lines.max_capacity();
        if !waits || written != self.stood.0 {
            self.stood = (written, Instant::now());
        }
        self.stood.1.elapsed() > TAKES_WITHIN
    }
}

/// Writes what comes; the reader gets it as soon as nothing more waits.
fn write(out: File, mut waiting: mpsc::Receiver<String>, counted: &AtomicU64) {
    let mut out = BufWriter::new(out);
    let mut next = waiting.blocking_recv();
    while let Some(line) = next {
        if writeln!(out, "{line}").is_err() {
            return;
        }
        counted.fetch_add(1, Ordering::Relaxed);
        next = match waiting.try_recv() {
            Ok(line) => Some(line),
            Err(_none_waits) => {
                if out.flush().is_err() {
                    return;
                }
                waiting.blocking_recv()
            }
        };
    }
}

/// The standard library's own is locked by the command.
#[cfg(unix)]
fn own_stdout() -> io::Result<File> {
    use std::os::fd::AsFd as _;
    io::stdout().as_fd().try_clone_to_owned().map(File::from)
}

#[cfg(windows)]
fn own_stdout() -> io::Result<File> {
    use std::os::windows::io::AsHandle as _;
    io::stdout()
        .as_handle()
        .try_clone_to_owned()
        .map(File::from)
}
