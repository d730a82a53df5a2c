//! The person's or the system's wish that the program ends: Ctrl-C, and on Unix SIGTERM and SIGHUP. Ends nothing itself.

use anyhow::Context as _;
#[cfg(unix)]
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Listens from its making on, so that no wish is missed.
pub(crate) struct Interrupt {
    #[cfg(unix)]
    signals: [Signal; 3],
}

#[cfg(unix)]
impl Interrupt {
    /// Begins to listen. Must be called within a tokio runtime.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        let on = |kind| signal(kind).context("cannot listen for Ctrl-C");
        Ok(Self {
            signals: [
                on(SignalKind::interrupt())?,
                on(SignalKind::terminate())?,
                on(SignalKind::hangup())?,
            ],
        })
    }

    /// Resolves at the first wish. May be dropped and called again.
    pub(crate) async fn wished(&mut self) {
        let [interrupt, terminate, hangup] = &mut self.signals;
        tokio::select! {
            biased;
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup.recv() => {}
        }
    }
}

#[cfg(not(unix))]
impl Interrupt {
    /// Begins to listen. Must be called within a tokio runtime.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        Ok(Self {})
    }

    /// Resolves at the first wish. May be dropped and called again.
    pub(crate) async fn wished(&mut self) {
        if tokio::signal::ctrl_c()
            .await
            .context("cannot listen")
            .is_err()
        {
            std::future::pending::<()>().await;
        }
    }
}
