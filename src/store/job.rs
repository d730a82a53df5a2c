//! Work off the window's thread, and its result.

use std::io;
use std::sync::Arc;
use tokio::runtime::Handle;
use tokio::sync::oneshot;

/// Runs file work on a thread that may block.
///
/// # Errors
/// The error of the work, or that the program is ending.
pub async fn on_thread<T: Send + 'static>(
    work: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> io::Result<T> {
    match tokio::task::spawn_blocking(work).await {
        Ok(done) => done,
        Err(_ending) => Err(io::Error::other("the program is ending")),
    }
}

/// A task that runs in the background and yields one result.
#[derive(Debug)]
pub struct BackgroundJob<T>(oneshot::Receiver<T>);

impl<T: Send + 'static> BackgroundJob<T> {
    /// Starts the job; `wake` is called when it has ended.
    pub fn start(
        runtime: &Handle,
        wake: &Arc<dyn Fn() + Send + Sync>,
        work: impl Future<Output = T> + Send + 'static,
    ) -> Self {
        Self::start_fallible(runtime, wake, async move { Some(work.await) })
    }

    /// Starts a job that may yield no result.
    pub fn start_fallible(
        runtime: &Handle,
        wake: &Arc<dyn Fn() + Send + Sync>,
        work: impl Future<Output = Option<T>> + Send + 'static,
    ) -> Self {
        let (sender, ended) = oneshot::channel();
        let wake = Arc::clone(wake);
        runtime.spawn(async move {
            if let Some(end) = work.await {
                // A dropped receiver means that the result is not needed.
                let _sent = sender.send(end);
            }
            wake();
        });
        Self(ended)
    }

    /// Returns the result once it is available, and clears the slot. A job that ended without a result also clears it.
    pub fn take_from(slot: &mut Option<Self>) -> Option<T> {
        let end = slot.as_mut()?.0.try_recv();
        if !matches!(end, Err(oneshot::error::TryRecvError::Empty)) {
            *slot = None;
        }
        end.ok()
    }
}
