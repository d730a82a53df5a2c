//! Signals: Ctrl-C, and on Unix SIGTERM and SIGHUP, ask the program to end; SIGUSR1 cuts the power of the simulated hand,
//! SIGUSR2 freezes what it tells. Ends nothing itself.

#[cfg(unix)]
use anyhow::Context as _;
#[cfg(unix)]
use futures::future::{FutureExt as _, select_all};
#[cfg(unix)]
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Signals of one meaning. Listens from its creation on, so that no signal is missed.
pub(crate) struct Interrupt {
    #[cfg(unix)]
    signals: Vec<Signal>,
    #[cfg(not(unix))]
    is_ctrl_c: bool,
}

#[cfg(unix)]
impl Interrupt {
    /// Listens for the wish to end the program. Must be called within a tokio runtime.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        Self::on(&[
            SignalKind::interrupt(),
            SignalKind::terminate(),
            SignalKind::hangup(),
        ])
        .context("cannot listen for Ctrl-C")
    }

    /// Listens for a request to cut the simulated hand's power for a moment: SIGUSR1. Must be called within a tokio runtime.
    pub(crate) fn power_cut() -> anyhow::Result<Self> {
        Self::on(&[SignalKind::user_defined1()]).context("cannot listen for SIGUSR1")
    }

    /// Listens for a request to freeze what the simulated hand tells, or to undo that: SIGUSR2. Must be called within a tokio
    /// runtime.
    pub(crate) fn freeze() -> anyhow::Result<Self> {
        Self::on(&[SignalKind::user_defined2()]).context("cannot listen for SIGUSR2")
    }

    fn on(kinds: &[SignalKind]) -> std::io::Result<Self> {
        let signals = kinds.iter().map(|kind| signal(*kind));
        signals
            .collect::<Result<_, _>>()
            .map(|signals| Self { signals })
    }

    /// Resolves at the next signal. May be dropped and called again.
    pub(crate) async fn wished(&mut self) {
        select_all(self.signals.iter_mut().map(|signal| signal.recv().boxed())).await;
    }
}

#[cfg(not(unix))]
impl Interrupt {
    /// Listens for the wish to end the program. Must be called within a tokio runtime.
    pub(crate) fn listen() -> anyhow::Result<Self> {
        Ok(Self { is_ctrl_c: true })
    }

    /// Nothing to listen for here.
    pub(crate) fn power_cut() -> anyhow::Result<Self> {
        Ok(Self { is_ctrl_c: false })
    }

    /// Nothing to listen for here.
    pub(crate) fn freeze() -> anyhow::Result<Self> {
        Ok(Self { is_ctrl_c: false })
    }

    /// Resolves at the next signal. May be dropped and called again.
    pub(crate) async fn wished(&mut self) {
        if !self.is_ctrl_c || tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    }
}
