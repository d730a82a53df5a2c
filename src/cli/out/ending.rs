//! Interruption by the user of a command that does not use a runtime.

use crate::shell::interrupt::Interrupt;
use anyhow::Context as _;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tokio::runtime::Builder;

/// Set once the user interrupts a command that checks it.
#[derive(Debug, Clone)]
pub(crate) struct EndFlag(Arc<AtomicBool>);

impl EndFlag {
    /// Starts listening for signals. From then on the command must end by itself.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        let runtime = Builder::new_current_thread().enable_all().build();
        let runtime = runtime.context("cannot listen for Ctrl-C")?;
        let within = runtime.enter();
        let mut interrupt = Interrupt::listen()?;
        drop(within);
        let wished = Self(Arc::default());
        let flag = wished.clone();
        let listens = move || {
            runtime.block_on(interrupt.wished());
            flag.0.store(true, Ordering::Relaxed);
        };
        let thread = std::thread::Builder::new().name("signals".into());
        thread.spawn(listens).context("cannot listen for Ctrl-C")?;
        Ok(wished)
    }

    /// Never set: there is nothing to clean up.
    pub(crate) fn never() -> Self {
        Self(Arc::default())
    }

    /// Continues until the user interrupts.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
