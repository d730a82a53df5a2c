//! Ctrl-C while a hand is written to: nothing is left half done without a word. Before the first write it ends the command; after
//! that the command goes on to its end, or rolls back, and tells what the hand holds; the second Ctrl-C ends it at once.

use crate::cli::out::say;
use crate::shell::interrupt::Interrupt;
use anyhow::bail;
use std::cell::Cell;
use std::rc::Rc;

/// Listens for the user, or the system, that wants the command to end.
pub(crate) struct Patience {
    interrupt: Interrupt,
    is_written: Rc<Cell<bool>>,
}

impl Patience {
    /// From now on no signal ends the program by itself.
    pub(crate) fn begin() -> anyhow::Result<Self> {
        Ok(Self {
            interrupt: Interrupt::listen()?,
            is_written: Rc::default(),
        })
    }

    /// To be set once something may have been written to the hand.
    pub(crate) fn written(&self) -> Rc<Cell<bool>> {
        Rc::clone(&self.is_written)
    }

    /// Waits for what may write, also if the user wants to end it meanwhile. `unknown` says what is not known if they do so twice.
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
                bail!("ended before anything was written to the hand");
            }
            if std::mem::replace(&mut is_asked, true) {
                bail!("ended at once: {unknown}");
            }
            say(
                "this is finished first, and then told what the hand holds; Ctrl-C again ends at once",
            );
        }
    }
}
