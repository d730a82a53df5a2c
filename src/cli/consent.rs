//! Consent of the user: a line entered after a question. Text that was typed, piped or repeated before does not count.

use std::io::{self, IsTerminal as _};
use tokio::task::spawn_blocking;

/// What the user said that answers may come from, where that is not their terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ConsentFrom {
    /// A line of standard input, whatever that is.
    Stdin,
}

/// Reason why there is no consent.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoConsent {
    /// Standard input is not a terminal, or belongs to another program.
    #[error(
        "there is no terminal here to ask for consent; start it in a terminal, or answer each question over standard input with --consent stdin"
    )]
    NoTerminal,
    /// Lines arrive continuously, independent of questions.
    #[cfg(unix)]
    #[error("standard input does not pause, so none of its lines is an answer")]
    NeverQuiet,
    /// On this system, earlier input cannot be distinguished from an answer.
    #[cfg(not(unix))]
    #[error(
        "consent cannot be asked for here: only Linux and macOS can distinguish an answer from earlier input; follow in the window, and grant control there"
    )]
    NotHere,
    /// Standard input has ended.
    #[error("standard input ended without an answer")]
    Ended,
    /// I/O error of the system.
    #[error("standard input cannot be read: {0}")]
    Io(io::ErrorKind),
}

impl From<io::Error> for NoConsent {
    fn from(error: io::Error) -> Self {
        Self::Io(error.kind())
    }
}

/// Checks that a question can be answered, before anything that leads to one.
pub(crate) fn can_answer(from: Option<ConsentFrom>) -> Result<(), NoConsent> {
    let is_answered_here = from.is_some() || io::stdin().is_terminal() && input::is_ours();
    is_answered_here.then_some(()).ok_or(NoConsent::NoTerminal)
}

/// Discards earlier input. Must be called immediately before the question.
pub(crate) async fn forget_earlier(from: Option<ConsentFrom>) -> Result<(), NoConsent> {
    let forgotten = spawn_blocking(move || {
        can_answer(from)?;
        input::forget()
    });
    // The task fails only at program exit.
    forgotten.await.unwrap_or(Err(NoConsent::Ended))
}

/// Waits for the line that answers. Must be called immediately after the question.
pub(crate) async fn answer() -> Result<(), NoConsent> {
    spawn_blocking(input::line)
        .await
        .unwrap_or(Err(NoConsent::Ended))
}

#[cfg(unix)]
mod input {
    use super::NoConsent;
    use nix::errno::Errno;
    use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
    use nix::sys::termios::{FlushArg, tcflush};
    use nix::unistd::{getpgrp, read, tcgetpgrp};
    use std::io::{self, IsTerminal as _, Stdin};
    use std::os::fd::AsFd as _;
    use std::time::{Duration, Instant};

    /// Silence in milliseconds after which earlier input has ended: a held key repeats faster.
    const QUIET_MS: u16 = 100;
    /// Maximum time to wait for silence.
    const QUIET_TIMEOUT: Duration = Duration::from_secs(3);

    /// True if keys go to this program, and not to another one on the same terminal.
    pub(super) fn is_ours() -> bool {
        match tcgetpgrp(io::stdin()) {
            Ok(group) => group == getpgrp(),
            // Not the controlling terminal: reading it stops no process.
            Err(error) => error == Errno::ENOTTY,
        }
    }

    pub(super) fn forget() -> Result<(), NoConsent> {
        let input = io::stdin();
        let begun = Instant::now();
        let mut bytes = [0; 4096];
        while is_ready(&input)? {
            if begun.elapsed() > QUIET_TIMEOUT {
                return Err(NoConsent::NeverQuiet);
            }
            if next(&input, &mut bytes)? == 0 {
                return Err(NoConsent::Ended);
            }
        }
        if input.is_terminal() {
            // Also discards a line that was typed but not entered.
            tcflush(&input, FlushArg::TCIFLUSH).map_err(io::Error::from)?;
        }
        Ok(())
    }

    pub(super) fn line() -> Result<(), NoConsent> {
        let input = io::stdin();
        let mut byte = [0];
        // Byte by byte: input after the line end belongs to the next question, which discards it.
        while byte != *b"\n" {
            if next(&input, &mut byte)? == 0 {
                return Err(NoConsent::Ended);
            }
        }
        Ok(())
    }

    /// True if input is available, or arrives within the silence period.
    fn is_ready(input: &Stdin) -> Result<bool, NoConsent> {
        let mut asked = [PollFd::new(input.as_fd(), PollFlags::POLLIN)];
        match poll(&mut asked, PollTimeout::from(QUIET_MS)) {
            Ok(ready) => Ok(ready > 0),
            Err(Errno::EINTR) => Ok(false),
            Err(error) => Err(io::Error::from(error).into()),
        }
    }

    /// Bypasses the buffer of the standard library, which would retain earlier input.
    fn next(input: &Stdin, bytes: &mut [u8]) -> Result<usize, NoConsent> {
        loop {
            match read(input, bytes) {
                Err(Errno::EINTR) => {}
                // The other end of the terminal is closed.
                Err(Errno::EIO) => return Ok(0),
                read => return Ok(read.map_err(io::Error::from)?),
            }
        }
    }
}

/// Not supported: earlier input cannot be distinguished from an answer.
#[cfg(not(unix))]
mod input {
    use super::NoConsent;

    pub(super) const fn is_ours() -> bool {
        true
    }

    pub(super) fn forget() -> Result<(), NoConsent> {
        Err(NoConsent::NotHere)
    }

    pub(super) fn line() -> Result<(), NoConsent> {
        Err(NoConsent::NotHere)
    }
}
