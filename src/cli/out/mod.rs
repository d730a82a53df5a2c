//! Standard output, locked once and buffered, and messages on standard error. A reader that goes away ends the command
//! quietly.

pub(crate) mod progress;

use serde::Serialize;
use std::io::{self, BufWriter, Write};

/// Size of the buffer: some twenty samples, so that a full-rate stream does not cost a system call per line.
const GATHERED: usize = 64 * 1024;

/// Where a command's results go. Everything written shows at [`Out::flush`] at the latest.
pub(crate) struct Out {
    to: BufWriter<Box<dyn Write>>,
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
    pub(crate) fn stdout() -> Self {
        Self::to(Box::new(io::stdout().lock()))
    }

    fn to(to: Box<dyn Write>) -> Self {
        Self {
            to: BufWriter::with_capacity(GATHERED, to),
        }
    }

    /// Writes one line.
    pub(crate) fn line(&mut self, line: &str) -> anyhow::Result<()> {
        checked(writeln!(self.to, "{line}"))
    }

    /// Writes lines.
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
        self.line(&serde_json::to_value(object)?.to_string())
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

    /// Shows everything written so far.
    pub(crate) fn flush(&mut self) -> anyhow::Result<()> {
        checked(self.to.flush())
    }
}

fn checked(written: io::Result<()>) -> anyhow::Result<()> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(ReaderGone.into()),
        Err(error) => Err(anyhow::Error::new(error).context("cannot write to standard output")),
        Ok(()) => Ok(()),
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

/// Prints a message on standard error.
pub(crate) fn say(words: &str) {
    // Where nobody can read, nobody can be told.
    let _unread = writeln!(io::stderr().lock(), "handscope: {words}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::rc::Rc;

    struct Page(Rc<RefCell<Vec<u8>>>);

    impl Write for Page {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.borrow_mut().extend_from_slice(bytes);
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

    #[test]
    fn lines_are_gathered_until_the_flush() {
        let page = Rc::new(RefCell::new(Vec::new()));
        let mut out = Out::to(Box::new(Page(Rc::clone(&page))));
        out.line("one").unwrap();
        out.line("two").unwrap();
        assert!(page.borrow().is_empty());
        out.flush().unwrap();
        assert_eq!(*page.borrow(), b"one\ntwo\n");
    }

    #[test]
    fn a_closed_reader_is_told_from_other_failures() {
        let mut out = Out::to(Box::new(Closed));
        out.line("one").unwrap();
        assert!(out.flush().unwrap_err().is::<ReaderGone>());
    }
}
