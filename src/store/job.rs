//! Work off the window's thread, and its result when it is there.

use std::io;
use std::sync::Arc;
use tokio::runtime::Handle;
use tokio::sync::oneshot;

/// Does something with files on a thread that may wait.
///
/// # Errors
/// What the work says, or that the program is ending.
pub async fn on_thread<T: Send + 'static>(
    work: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> io::Result<T> {
    match tokio::task::spawn_blocking(work).await {
        Ok(done) => done,
        Err(_ending) => Err(io::Error::other("the program is ending")),
    }
}

/// Something that goes on elsewhere and comes to one result.
#[derive(Debug)]
pub struct BackgroundJob<T>(oneshot::Receiver<T>);

impl<T: Send + 'static> BackgroundJob<T> {
    /// Begins it. `wake` is called once the result is there.
    pub fn start(
        runtime: &Handle,
        wake: &Arc<dyn Fn() + Send + Sync>,
        work: impl Future<Output = T> + Send + 'static,
    ) -> Self {
        Self::start_fallible(runtime, wake, async move { Some(work.await) })
    }

    /// The same for work that may come to no result.
    pub fn start_fallible(
        runtime: &Handle,
        wake: &Arc<dyn Fn() + Send + Sync>,
        work: impl Future<Output = Option<T>> + Send + 'static,
    ) -> Self {
        let (told, ended) = oneshot::channel();
        let wake = Arc::clone(wake);
        runtime.spawn(async move {
            if let Some(end) = work.await {
                // A receiver that is gone means that nobody wants to know.
                let _told = told.send(end);
            }
            wake();
        });
        Self(ended)
    }

    /// The result, once it is there; then the job is gone. A job that came to no result is gone too.
    pub fn take_from(slot: &mut Option<Self>) -> Option<T> {
        let end = slot.as_mut()?.0.try_recv();
        if !matches!(end, Err(oneshot::error::TryRecvError::Empty)) {
            *slot = None;
        }
        end.ok()
    }
}
