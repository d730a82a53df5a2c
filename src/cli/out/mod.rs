//! Standard output and messages on standard error. Each is written by a thread of its own, so that a slow reader does not delay
//! a hand. A closed reader ends the command quietly.

pub(crate) mod ending;
pub(crate) mod failure;
pub(crate) mod file;
mod messages;
pub(crate) mod progress;
mod writer;

pub(crate) use crate::cli::out::messages::{finish_messages, notify};

use crate::cli::out::messages::{READ_AT_ONCE, drained};
use crate::cli::out::writer::{LineClass, LineWriter, OutputError};
use crate::printable;
use anyhow::{Context as _, bail};
use serde::Serialize;
use serde_json::json;
use std::io::{self, Write};

/// Output of a command's results.
pub(crate) struct Out {
    to: LineWriter,
    /// Number of stream lines dropped since the last report, and in total.
    lost: u64,
    lost_total: u64,
    /// True if the end waits for a slow reader.
    waits: bool,
}

/// The reader of the output has closed it, as `head` does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the output was closed by its reader")]
pub(crate) struct ReaderGone;

/// The command failed and has already reported the reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("already reported")]
pub(crate) struct AlreadyReported;

/// Wrong usage that clap cannot detect. Nothing was done.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WrongUsage(pub(crate) String);

impl WrongUsage {
    /// Converts it into a command error.
    pub(crate) fn error(why: impl Into<String>) -> anyhow::Error {
        Self(why.into()).into()
    }
}

impl Out {
    /// Standard output of the process.
    pub(crate) fn stdout() -> anyhow::Result<Self> {
        Self::to(io::stdout())
    }

    fn to(to: impl Write + Send + 'static) -> anyhow::Result<Self> {
        let to = LineWriter::start("stdout", to);
        Ok(Self {
            to: to.context("cannot start: no thread can be started to write the output")?,
            lost: 0,
            lost_total: 0,
            waits: true,
        })
    }

    /// Writes one line of a result, as text.
    pub(crate) fn line(&mut self, line: &str) -> anyhow::Result<()> {
        self.write(format!("{}\n", printable::line(line)).as_bytes())
    }

    /// Writes lines of a result.
    pub(crate) fn lines(
        &mut self,
        lines: impl IntoIterator<Item = impl AsRef<str>>,
    ) -> anyhow::Result<()> {
        lines
            .into_iter()
            .try_for_each(|line| self.line(line.as_ref()))
    }

    /// Writes one JSON object on a line, its fields sorted by name.
    pub(crate) fn object(&mut self, object: &impl Serialize) -> anyhow::Result<()> {
        let json = serde_json::to_value(object)?.to_string();
        self.write(json_line(&json).as_bytes())
    }

    /// Writes a result, as one JSON object or as lines.
    pub(crate) fn result(
        &mut self,
        as_json: bool,
        object: &impl Serialize,
        lines: impl IntoIterator<Item = impl AsRef<str>>,
    ) -> anyhow::Result<()> {
        if as_json {
            self.object(object)
        } else {
            self.lines(lines)
        }
    }

    /// Writes one line of a stream. It is dropped and counted while the queue is full.
    pub(crate) fn stream_line(&mut self, line: &str) -> anyhow::Result<()> {
        let mut bytes = match self.lost {
            0 => String::new(),
            lost => format!("({lost} lines were not read in time and are left out)\n"),
        };
        bytes.push_str(&printable::line(line));
        bytes.push('\n');
        self.stream(bytes.as_bytes())
    }

    /// Writes one JSON object of a stream, as [`Self::stream_line`] does.
    pub(crate) fn stream_object(&mut self, object: &impl Serialize) -> anyhow::Result<()> {
        self.stream_json(&serde_json::to_value(object)?.to_string())
    }

    /// Writes one JSON line of a stream, as [`Self::stream_line`] does. An object in place of dropped ones holds their number.
    pub(crate) fn stream_json(&mut self, json: &str) -> anyhow::Result<()> {
        let mut bytes = match self.lost {
            0 => String::new(),
            lost => json_line(&json!({ "lost": lost }).to_string()),
        };
        bytes.push_str(&json_line(json));
        self.stream(bytes.as_bytes())
    }

    /// Counts samples of the stream that did not arrive here.
    pub(crate) const fn missed(&mut self, samples: u64) {
        self.lost += samples;
    }

    /// Fails if earlier output could not be written. Writing does not require this call.
    pub(crate) fn flush(&self) -> anyhow::Result<()> {
        self.to.check().map_err(failed)
    }

    /// Fails if the output cannot be written. Waits for an active reader, so it must not be used while a hand moves.
    pub(crate) fn shown(&self) -> anyhow::Result<()> {
        let left = self.to.drained(|stalled| stalled < READ_AT_ONCE);
        left.map(drop).map_err(failed)
    }

    /// Number of bytes queued, and of bytes written so far.
    pub(crate) fn progress(&self) -> (usize, u64) {
        self.to.progress()
    }

    /// Limits the wait at the end for a reader that does not read.
    pub(crate) const fn end_without_reader(&mut self) {
        self.waits = false;
    }

    /// Waits until everything is written. As in every program, a slow reader is awaited, until a signal ends that.
    pub(crate) fn finish(self) -> anyhow::Result<()> {
        let left = drained(&self.to, self.waits).map_err(failed)?;
        if self.lost_total > 0 {
            notify(&format!(
                "{} lines of output were not read in time and are left out",
                self.lost_total
            ));
        }
        if left > 0 && self.waits {
            bail!("the last {left} bytes of output were not read");
        }
        Ok(())
    }

    fn stream(&mut self, lines: &[u8]) -> anyhow::Result<()> {
        if self.to.push(lines, LineClass::Stream).map_err(failed)? {
            self.lost = 0;
        } else {
            self.lost += 1;
            self.lost_total += 1;
        }
        Ok(())
    }

    fn write(&self, lines: &[u8]) -> anyhow::Result<()> {
        while !self.to.push(lines, LineClass::Result).map_err(failed)? {
            // A thread that runs links must not wait for a reader.
            if tokio::runtime::Handle::try_current().is_ok() {
                return Err(failed(OutputError::Full));
            }
            self.to.wait_for_room();
        }
        Ok(())
    }
}

fn json_line(json: &str) -> String {
    format!("{}\n", printable::json(json))
}

fn failed(end: OutputError) -> anyhow::Error {
    match end {
        OutputError::Io(io::ErrorKind::BrokenPipe) => ReaderGone.into(),
        end => anyhow::Error::new(end).context("cannot write to standard output"),
    }
}

/// Result of a command that has already reported everything.
pub(crate) fn end(is_done: bool) -> anyhow::Result<()> {
    if is_done {
        Ok(())
    } else {
        Err(AlreadyReported.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    #[derive(Clone, Default)]
    struct Page(Arc<Mutex<Vec<u8>>>);

    impl Page {
        fn text(&self) -> String {
            String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
        }
    }

    impl Write for Page {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    struct Closed;

    impl Write for Closed {
        fn write(&mut self, _bytes: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::BrokenPipe.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// Takes nothing until it is opened.
    struct Gate(Arc<Mutex<()>>, Page);

    impl Write for Gate {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let _open = self.0.lock().unwrap();
            self.1.write(bytes)
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn text_is_escaped_and_json_says_the_same() {
        let page = Page::default();
        let mut out = Out::to(page.clone()).unwrap();
        let hostile = "a\u{1b}[2J\u{202e}b\nc";
        out.line(hostile).unwrap();
        out.stream_line(hostile).unwrap();
        out.object(&json!({ "topic": hostile })).unwrap();
        out.finish().unwrap();
        let text = page.text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "a\\u{1b}[2J\\u{202e}b\\nc");
        assert_eq!(lines[1], lines[0]);
        assert_eq!(lines[2], r#"{"topic":"a\u001b[2J\u202eb\nc"}"#);
        assert_eq!(lines.len(), 3);
    }

    #[test]
    fn a_closed_reader_is_told_from_other_failures() {
        let mut out = Out::to(Closed).unwrap();
        out.line("one").unwrap();
        assert!(out.finish().unwrap_err().is::<ReaderGone>());
    }

    #[test]
    fn lines_of_a_stream_that_are_not_read_are_counted_where_they_are_missing() {
        let (gate, page) = (Arc::new(Mutex::new(())), Page::default());
        let shut = gate.lock().unwrap();
        let mut out = Out::to(Gate(Arc::clone(&gate), page.clone())).unwrap();
        let sample = json!({ "words": "x".repeat(1000) });
        for _ in 0..2000 {
            out.stream_object(&sample).unwrap();
        }
        let lost = out.lost_total;
        assert!((900..1000).contains(&lost), "{lost}");
        out.object(&json!({ "result": 1 })).unwrap();
        drop(shut);
        out.to.drained(|_| true).unwrap();
        out.stream_object(&sample).unwrap();
        assert_eq!(out.lost, 0);
        out.finish().unwrap();
        let text = page.text();
        let lines: Vec<&str> = text
            .lines()
            .skip(2000 - usize::try_from(lost).unwrap())
            .collect();
        assert_eq!(
            lines[..2],
            [r#"{"result":1}"#.into(), format!(r#"{{"lost":{lost}}}"#)]
        );
        assert_eq!(lines.len(), 3);
    }
}
