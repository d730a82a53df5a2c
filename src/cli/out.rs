//! Standard output, locked once and flushed by line. A reader that went away ends the command quietly.

use std::io::{self, Write};

/// Where a command's results go.
pub(crate) struct Out {
    to: Box<dyn Write>,
}

/// The reader of our output closed it, as `head` does.
#[derive(Debug, thiserror::Error)]
#[error("the reader of the output went away")]
pub(crate) struct ReaderGone;

impl Out {
    /// The process's standard output.
    pub(crate) fn stdout() -> Self {
        Self { to: Box::new(io::stdout().lock()) }
    }

    /// Writes one line.
    pub(crate) fn line(&mut self, line: &str) -> anyhow::Result<()> {
        let written = writeln!(self.to, "{line}").and_then(|()| self.to.flush());
        match written {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(ReaderGone.into()),
            other => Ok(other?),
        }
    }
}

/// Tells a person on standard error what is going on.
pub(crate) fn say(words: &str) {
    let _nobody_reads = writeln!(io::stderr().lock(), "{words}");
}
