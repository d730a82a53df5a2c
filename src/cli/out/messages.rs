//! Messages on standard error, and the wait for a reader at the end of the program.

use crate::cli::out::ending::EndFlag;
use crate::cli::out::writer::{LineClass, LineWriter, OutputError};
use crate::printable;
use crate::shell::interrupt;
use std::io::{self, Write as _};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// After a signal, output that is not read for this time is discarded: the user requested the end.
const UNREAD_TIMEOUT: Duration = Duration::from_secs(1);
/// An active reader has read the output by then; signals are listened for only after that.
pub(crate) const READ_AT_ONCE: Duration = Duration::from_millis(100);

/// Writer of standard error; `None` if its thread cannot be started.
fn messages() -> Option<&'static LineWriter> {
    static MESSAGES: OnceLock<Option<LineWriter>> = OnceLock::new();
    let started = || LineWriter::start("stderr", io::stderr()).ok();
    MESSAGES.get_or_init(started).as_ref()
}

pub(crate) fn notify(words: &str) {
    push_line(&format!("handscope: {}", printable::line(words)));
}

/// Prints one printable line.
pub(crate) fn push_line(text: &str) {
    static LOST: AtomicU64 = AtomicU64::new(0);
    let mut line = match LOST.load(Ordering::Relaxed) {
        0 => String::new(),
        lost => format!("handscope: {lost} messages were not read in time and are left out\n"),
    };
    line.push_str(text);
    line.push('\n');
    match messages() {
        Some(messages) => match messages.push(line.as_bytes(), LineClass::Result) {
            Ok(true) => LOST.store(0, Ordering::Relaxed),
            // Without a reader, the loss cannot be reported.
            Ok(false) | Err(_) => {
                LOST.fetch_add(1, Ordering::Relaxed);
            }
        },
        None => {
            let _unread = io::stderr().write_all(line.as_bytes());
        }
    }
}

/// Prints raw text on the terminal at standard error, in place of the current line.
pub(crate) fn show(text: &str) {
    if let Some(messages) = messages() {
        let _unread = messages.push(text.as_bytes(), LineClass::Stream);
    }
}

/// Waits until the messages are written, as the end of [`super::Out`] does.
pub(crate) fn finish_messages() {
    if let Some(messages) = messages() {
        let _unread = drained(messages, true);
    }
}

/// Waits until everything is written; returns the number of bytes left. A slow reader is awaited until a signal arrives.
pub(crate) fn drained(writer: &LineWriter, waits: bool) -> Result<usize, OutputError> {
    let left = writer.drained(|stalled| stalled < READ_AT_ONCE)?;
    if left == 0 {
        return Ok(0);
    }
    match EndFlag::listen() {
        Ok(end) if waits && !interrupt::came() => writer.drained(|_| end.flow().is_continue()),
        _ => writer.drained(|stalled| stalled < UNREAD_TIMEOUT),
    }
}
