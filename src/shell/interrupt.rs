//! Signals: Ctrl-C, and on Unix SIGTERM and SIGHUP, on Windows Ctrl-Break and the end of console or session, ask the program to
//! end; SIGUSR1 cuts the power of the simulated hand, SIGUSR2 freezes its feedback. Ends nothing itself.

use futures::stream::{BoxStream, SelectAll, StreamExt as _, poll_fn, select_all};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};

/// True once a signal that ends the program was received.
static CAME: AtomicBool = AtomicBool::new(false);

/// True if a signal requested the end of the program.
pub(crate) fn came() -> bool {
    CAME.load(Ordering::Relaxed)
}

/// Error for a signal that cannot be listened for.
#[derive(Debug, thiserror::Error)]
#[error("cannot listen for {signal}")]
pub(crate) struct ListenError {
    signal: &'static str,
    #[source]
    cause: io::Error,
}

/// Signals of one meaning. Listens from creation on, so that no signal is missed.
pub(crate) struct Interrupt {
    /// Streams that yield the exit status of each signal.
    signals: SelectAll<BoxStream<'static, i32>>,
}

/// Signal streams of one meaning, or the system's error.
type Signals = io::Result<Vec<BoxStream<'static, i32>>>;

impl Interrupt {
    /// Listens for requests to end the program. Must be called within a tokio runtime.
    pub(crate) fn listen() -> Result<Self, ListenError> {
        let noted = |signal: BoxStream<'static, i32>| {
            signal
                .inspect(|_status| CAME.store(true, Ordering::Relaxed))
                .boxed()
        };
        let signals = system::end().map(|signals| signals.into_iter().map(noted).collect());
        Self::of("Ctrl-C", signals)
    }

    /// Listens for a request to cut the simulated hand's power for a moment: SIGUSR1. Must be called within a tokio runtime.
    pub(crate) fn power_cut() -> Result<Self, ListenError> {
        Self::of("SIGUSR1", system::power_cut())
    }

    /// Listens for a request to freeze the simulated hand's feedback, or to undo that: SIGUSR2. Must be called within a tokio
    /// runtime.
    pub(crate) fn freeze() -> Result<Self, ListenError> {
        Self::of("SIGUSR2", system::freeze())
    }

    fn of(signal: &'static str, signals: Signals) -> Result<Self, ListenError> {
        match signals {
            Ok(signals) => Ok(Self {
                signals: select_all(signals),
            }),
            Err(cause) => Err(ListenError { signal, cause }),
        }
    }

    /// Resolves at the next signal. May be dropped and called again.
    pub(crate) async fn wished(&mut self) {
        self.status().await;
    }

    /// Resolves at the next signal, to the exit status of a program ended by it.
    pub(crate) async fn status(&mut self) -> i32 {
        match self.signals.next().await {
            Some(status) => status,
            // This system has no such signal.
            None => std::future::pending().await,
        }
    }
}

fn signal_stream(
    status: i32,
    mut poll: impl FnMut(&mut Context<'_>) -> Poll<Option<()>> + Send + 'static,
) -> BoxStream<'static, i32> {
    poll_fn(move |context| poll(context).map(|came| came.map(|()| status))).boxed()
}

#[cfg(unix)]
mod system {
    use super::{BoxStream, Signals, signal_stream};
    use std::io;
    use tokio::signal::unix::{SignalKind, signal};

    pub(super) fn end() -> Signals {
        let kinds = [
            SignalKind::interrupt(),
            SignalKind::terminate(),
            SignalKind::hangup(),
        ];
        kinds.into_iter().map(on).collect()
    }

    pub(super) fn power_cut() -> Signals {
        on(SignalKind::user_defined1()).map(|signal| vec![signal])
    }

    pub(super) fn freeze() -> Signals {
        on(SignalKind::user_defined2()).map(|signal| vec![signal])
    }

    fn on(kind: SignalKind) -> io::Result<BoxStream<'static, i32>> {
        let mut signal = signal(kind)?;
        let status = 128 + kind.as_raw_value();
        Ok(signal_stream(status, move |context| {
            signal.poll_recv(context)
        }))
    }
}

#[cfg(windows)]
mod system {
    use super::{Signals, signal_stream};
    use tokio::signal::windows::{ctrl_break, ctrl_c, ctrl_close, ctrl_logoff, ctrl_shutdown};

    /// Exit status that Windows gives a program ended by Ctrl-C: 0xC000013A.
    const ENDED: i32 = -0x3fff_fec6;

    /// Ctrl-C, Ctrl-Break, and the end of console or session, after which Windows allows a few seconds.
    pub(super) fn end() -> Signals {
        let (mut key, mut break_key) = (ctrl_c()?, ctrl_break()?);
        let (mut close, mut logoff, mut shutdown) =
            (ctrl_close()?, ctrl_logoff()?, ctrl_shutdown()?);
        Ok(vec![
            signal_stream(ENDED, move |context| key.poll_recv(context)),
            signal_stream(ENDED, move |context| break_key.poll_recv(context)),
            signal_stream(ENDED, move |context| close.poll_recv(context)),
            signal_stream(ENDED, move |context| logoff.poll_recv(context)),
            signal_stream(ENDED, move |context| shutdown.poll_recv(context)),
        ])
    }

    pub(super) fn power_cut() -> Signals {
        Ok(Vec::new())
    }

    pub(super) fn freeze() -> Signals {
        Ok(Vec::new())
    }
}
