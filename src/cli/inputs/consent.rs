//! Consent of the user: a line that was entered after it was asked for. What was typed, piped or repeated before does not count.

use std::io::{self, IsTerminal as _};
use tokio::task::spawn_blocking;

/// What the user said that answers may come from, where that is not their terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ConsentFrom {
    /// A line of standard input, whatever that is.
    Stdin,
}

/// Why nobody can be asked, or did not answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoConsent {
    /// Standard input is no terminal, or one that another program has.
    #[error(
        "nobody can press Enter here; start it in a terminal, or answer each question over standard input with --consent stdin"
    )]
    NoTerminal,
    /// Lines come whether anything is asked or not.
    #[cfg(unix)]
    #[error("standard input does not pause, so none of its lines is an answer")]
    NeverQuiet,
    /// What was typed before cannot be told from an answer on this system.
    #[cfg(not(unix))]
    #[error(
        "nobody can be asked here: only Linux and macOS tell an answer from what was typed before; follow in the window, where a person lets it move the hand"
    )]
    NotHere,
    /// There is no further line.
    #[error("standard input ended without an answer")]
    Ended,
    /// The system's.
    #[error("standard input cannot be read: {0}")]
    Io(io::ErrorKind),
}

impl From<io::Error> for NoConsent {
    fn from(error: io::Error) -> Self {
        Self::Io(error.kind())
    }
}

/// Throws away what came before anything was asked. To be called right before the question.
pub(crate) async fn forget_earlier(from: Option<ConsentFrom>) -> Result<(), NoConsent> {
    let forgotten = spawn_blocking(move || {
        let is_answered_here = from.is_some() || io::stdin().is_terminal() && input::is_ours();
        if is_answered_here {
            input::forget()
        } else {
            Err(NoConsent::NoTerminal)
        }
    });
    // It ends early only with the program.
    forgotten.await.unwrap_or(Err(NoConsent::Ended))
}

/// Waits for the line that answers. To be called right after the question.
pub(crate) async fn given() -> Result<(), NoConsent> {
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

    /// Input that says nothing for so long, milliseconds, has said what it had to: a key that is held down repeats faster.
    const QUIET_MS: u16 = 100;
    /// Input that is not quiet within this never is.
    const QUIET_TIMEOUT: Duration = Duration::from_secs(3);

    /// Whether keys go to this program, and not to another of the same terminal.
    pub(super) fn is_ours() -> bool {
        match tcgetpgrp(io::stdin()) {
            Ok(group) => group == getpgrp(),
            // Not the one that controls this program: nobody is stopped for reading it.
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
            // What was typed of a line that is not entered yet, too.
            tcflush(&input, FlushArg::TCIFLUSH).map_err(io::Error::from)?;
        }
        Ok(())
    }

    pub(super) fn line() -> Result<(), NoConsent> {
        let input = io::stdin();
        let mut byte = [0];
        // One by one: what follows the line end is left to the next question, which forgets it.
        while byte != *b"\n" {
            if next(&input, &mut byte)? == 0 {
                return Err(NoConsent::Ended);
            }
        }
        Ok(())
    }

    /// Whether there is something to read, or will be within the time that quiet takes.
    fn is_ready(input: &Stdin) -> Result<bool, NoConsent> {
        let mut asked = [PollFd::new(input.as_fd(), PollFlags::POLLIN)];
        match poll(&mut asked, PollTimeout::from(QUIET_MS)) {
            Ok(ready) => Ok(ready > 0),
            Err(Errno::EINTR) => Ok(false),
            Err(error) => Err(io::Error::from(error).into()),
        }
    }

    /// Past the buffer of the standard library, which would keep what nobody asked for.
    fn next(input: &Stdin, bytes: &mut [u8]) -> Result<usize, NoConsent> {
        loop {
            match read(input, bytes) {
                Err(Errno::EINTR) => {}
                // A terminal whose other end is closed.
                Err(Errno::EIO) => return Ok(0),
                read => return Ok(read.map_err(io::Error::from)?),
            }
        }
    }
}

/// Not known here: what was typed before cannot be told from an answer.
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
