//! Signals: Ctrl-C, and on Unix SIGTERM and SIGHUP, ask the program to end; SIGUSR1 cuts the power of the simulated hand. Ends
//! nothing itself.

use anyhow::Context as _;
#[cfg(unix)]
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Listens from its creation on, so that no signal is missed.
pub(crate) struct Interrupt {
    #[cfg(unix)]
    signals: [Signal; 3],
}

#[cfg(unix)]
impl Interrupt {
    /// Starts listening. Must be called within a tokio runtime.
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

    /// Resolves at the first signal. May be dropped and called again.
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
    /// Starts listening. Must be called within a tokio runtime.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        Ok(Self {})
    }

    /// Resolves at the first signal. May be dropped and called again.
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

/// A request to cut the simulated hand's power for a moment: SIGUSR1, where there are signals.
pub(crate) struct PowerCut {
    #[cfg(unix)]
    signal: Signal,
}

#[cfg(unix)]
impl PowerCut {
    /// Starts listening. Must be called within a tokio runtime.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        let signal = signal(SignalKind::user_defined1()).context("cannot listen for SIGUSR1")?;
        Ok(Self { signal })
    }

    /// Resolves at the next signal. May be dropped and called again.
    pub(crate) async fn wished(&mut self) {
        if self.signal.recv().await.is_none() {
            std::future::pending::<()>().await;
        }
    }
}

#[cfg(not(unix))]
impl PowerCut {
    /// Nothing to listen for here.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        Ok(Self {})
    }

    /// Never resolves.
    pub(crate) async fn wished(&mut self) {
        std::future::pending::<()>().await;
    }
}
