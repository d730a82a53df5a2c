//! Whether the user wishes the end of a command that does not run on a runtime.

use crate::shell::interrupt::Interrupt;
use anyhow::Context as _;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tokio::runtime::Builder;

/// Set once the user wishes the end of a command that looks at it.
#[derive(Debug, Clone)]
pub(crate) struct EndWished(Arc<AtomicBool>);

impl EndWished {
    /// Listens from now on. The command has to end by itself then.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        let runtime = Builder::new_current_thread().enable_all().build();
        let runtime = runtime.context("cannot listen for Ctrl-C")?;
        let within = runtime.enter();
        let mut interrupt = Interrupt::listen()?;
        drop(within);
        let wished = Self(Arc::default());
        let told = wished.clone();
        let listens = move || {
            runtime.block_on(interrupt.wished());
            told.0.store(true, Ordering::Relaxed);
        };
        let thread = std::thread::Builder::new().name("signals".into());
        thread.spawn(listens).context("cannot listen for Ctrl-C")?;
        Ok(wished)
    }

    /// One that is never set, because there is nothing to be tidied up.
    pub(crate) fn never() -> Self {
        Self(Arc::default())
    }

    /// Goes on until the end is wished.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
