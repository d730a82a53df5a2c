//! Standard output and messages on standard error. Both are written by threads of their own, so that no reader delays a hand. A
//! reader that goes away ends the command quietly.

pub(crate) mod ending;
pub(crate) mod file;
mod messages;
pub(crate) mod progress;
mod writer;

pub(crate) use crate::cli::out::messages::{finish_messages, say};

use crate::cli::out::messages::{READ_AT_ONCE, drained};
use crate::cli::out::writer::{LineClass, LineWriter, WriteEnd};
use crate::printable;
use anyhow::{Context as _, bail};
use serde::Serialize;
use serde_json::json;
use std::io::{self, Write};

/// Where a command's results go.
pub(crate) struct Out {
    to: LineWriter,
    /// Lines of streams that were left out since that was reported, and in all.
    lost: u64,
    lost_total: u64,
    /// The end waits for a reader that is slow.
    waits: bool,
}

/// The reader of our output closed it, as `head` does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the reader of the output went away")]
pub(crate) struct ReaderGone;

/// The command failed, and has already said why.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("already reported")]
pub(crate) struct AlreadyReported;

/// Wrong usage that clap cannot see. Nothing was done.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WrongUsage(pub(crate) String);

impl WrongUsage {
    /// As the error of a command.
    pub(crate) fn error(why: impl Into<String>) -> anyhow::Error {
        Self(why.into()).into()
    }
}

impl Out {
    /// The process's standard output.
    pub(crate) fn stdout() -> anyhow::Result<Self> {
        Self::to(io::stdout())
    }

    fn to(to: impl Write + Send + 'static) -> anyhow::Result<Self> {
        let to = LineWriter::start("stdout", to);
        Ok(Self {
            to: to.context("cannot begin: no thread can be started that writes the output")?,
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

    /// Writes one JSON object on a line, its fields in the order of their names.
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

    /// Writes one line of a stream. It is left out and counted while too much waits to be read.
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

    /// Writes one line of JSON of a stream, as [`Self::stream_line`] does. The number of objects that are left out stands in an object
    /// where they are missing.
    pub(crate) fn stream_json(&mut self, json: &str) -> anyhow::Result<()> {
        let mut bytes = match self.lost {
            0 => String::new(),
            lost => json_line(&json!({ "lost": lost }).to_string()),
        };
        bytes.push_str(&json_line(json));
        self.stream(bytes.as_bytes())
    }

    /// Samples of the stream that never came here.
    pub(crate) const fn missed(&mut self, samples: u64) {
        self.lost += samples;
    }

    /// Fails if what was written before could not be shown. It is shown without this.
    pub(crate) fn flush(&self) -> anyhow::Result<()> {
        self.to.check().map_err(failed)
    }

    /// Fails if what was written cannot be shown. Gives a reader that reads the time to take it, so not for what moves a hand.
    pub(crate) fn shown(&self) -> anyhow::Result<()> {
        let left = self.to.drained(|stalled| stalled < READ_AT_ONCE);
        left.map(drop).map_err(failed)
    }

    /// Bytes that wait to be read, and how many were read so far.
    pub(crate) fn progress(&self) -> (usize, u64) {
        self.to.progress()
    }

    /// The end waits no longer than a moment for a reader that does not read.
    pub(crate) const fn end_without_reader(&mut self) {
        self.waits = false;
    }

    /// Waits until everything is written. A reader may take its time, as with every program, until a signal ends that.
    pub(crate) fn finish(self) -> anyhow::Result<()> {
        let left = drained(&self.to, self.waits).map_err(failed)?;
        if self.lost_total > 0 {
            say(&format!(
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
            // A thread that runs links waits for no reader.
            if tokio::runtime::Handle::try_current().is_ok() {
                return Err(failed(WriteEnd::Full));
            }
            self.to.wait_for_room();
        }
        Ok(())
    }
}

fn json_line(json: &str) -> String {
    format!("{}\n", printable::json(json))
}

fn failed(end: WriteEnd) -> anyhow::Error {
    match end {
        WriteEnd::Io(io::ErrorKind::BrokenPipe) => ReaderGone.into(),
        end => anyhow::Error::new(end).context("cannot write to standard output"),
    }
}

/// How a command ends that has said everything already.
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
