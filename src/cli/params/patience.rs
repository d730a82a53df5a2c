//! Ctrl-C during writes to a hand: no write is left half done without a report. Before the first write, Ctrl-C ends the command;
//! after it, the command completes or rolls back, and reports the values in the hand; a second Ctrl-C ends it at once.

use crate::cli::out::failure::FailureKind;
use crate::cli::out::notify;
use crate::shell::interrupt::Interrupt;
use std::cell::Cell;
use std::rc::Rc;

/// Listens for interruption by the user or the system.
pub(crate) struct Patience {
    interrupt: Interrupt,
    is_written: Rc<Cell<bool>>,
}

impl Patience {
    /// Starts listening; from now on no signal ends the program by itself.
    pub(crate) fn begin() -> anyhow::Result<Self> {
        Ok(Self {
            interrupt: Interrupt::listen()?,
            is_written: Rc::default(),
        })
    }

    /// Flag to set once something may have been written to the hand.
    pub(crate) fn written(&self) -> Rc<Cell<bool>> {
        Rc::clone(&self.is_written)
    }

    /// Completes a task that may write, even if interrupted. `unknown` is the message after a second interruption.
    pub(crate) async fn see_through<T>(
        &mut self,
        work: impl Future<Output = T>,
        unknown: &str,
    ) -> anyhow::Result<T> {
        let mut work = std::pin::pin!(work);
        let mut is_asked = false;
        loop {
            tokio::select! {
                biased;
                done = &mut work => return Ok(done),
                () = self.interrupt.wished() => {}
            }
            if !self.is_written.get() {
                let words = "ended before anything was written to the hand";
                return Err(FailureKind::Interrupted.error(words));
            }
            if std::mem::replace(&mut is_asked, true) {
                let words = format!("ended at once: {unknown}");
                return Err(FailureKind::Interrupted.error(words));
            }
            notify(
                "this is finished first, then what the hand holds is reported; Ctrl-C again ends at once",
            );
        }
    }
}
