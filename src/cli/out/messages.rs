//! Messages on standard error, and how long the end of the program waits for a reader.

use crate::cli::out::ending::EndWished;
use crate::cli::out::writer::{LineClass, LineWriter, WriteEnd};
use crate::printable;
use crate::shell::interrupt;
use std::io::{self, Write as _};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// After a signal, output that is not read for this long is given up. It was the user who wanted the end.
const UNREAD_TIMEOUT: Duration = Duration::from_secs(1);
/// Output that is read at all is read by then: only later are signals listened for.
pub(crate) const READ_AT_ONCE: Duration = Duration::from_millis(100);

/// Standard error; `None` where no thread can be started for it.
fn messages() -> Option<&'static LineWriter> {
    static MESSAGES: OnceLock<Option<LineWriter>> = OnceLock::new();
    let started = || LineWriter::start("stderr", io::stderr()).ok();
    MESSAGES.get_or_init(started).as_ref()
}

/// Prints a message on standard error.
pub(crate) fn say(words: &str) {
    static LOST: AtomicU64 = AtomicU64::new(0);
    let mut line = match LOST.load(Ordering::Relaxed) {
        0 => String::new(),
        lost => format!("handscope: {lost} messages were not read in time and are left out\n"),
    };
    line.push_str("handscope: ");
    line.push_str(&printable::line(words));
    line.push('\n');
    match messages() {
        Some(messages) => match messages.push(line.as_bytes(), LineClass::Result) {
            Ok(true) => LOST.store(0, Ordering::Relaxed),
            // Where nobody can read, nobody can be told.
            Ok(false) | Err(_) => {
                LOST.fetch_add(1, Ordering::Relaxed);
            }
        },
        None => {
            let _unread = io::stderr().write_all(line.as_bytes());
        }
    }
}

/// Prints on the terminal at standard error as it is, in place of what stood in the line.
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

/// Waits until everything is written; gives the bytes that are left. Until a signal ends it, a reader may take its time.
pub(crate) fn drained(writer: &LineWriter, waits: bool) -> Result<usize, WriteEnd> {
    let left = writer.drained(|stalled| stalled < READ_AT_ONCE)?;
    if left == 0 {
        return Ok(0);
    }
    match EndWished::listen() {
        Ok(end) if waits && !interrupt::came() => writer.drained(|_| end.flow().is_continue()),
        _ => writer.drained(|stalled| stalled < UNREAD_TIMEOUT),
    }
}
