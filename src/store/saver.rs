//! Writes a persistent value when it changed, at most once a second and one write at a time.

use crate::store::file::replace_keeping_last;
use crate::store::job::on_thread;
use futures::FutureExt as _;
use std::io;
use std::path::PathBuf;
use std::time::Duration;
use tokio::task::JoinHandle;

/// Minimum interval of writes: typing a name or dragging a window changes settings many times a second.
const SAVE_EVERY: Duration = Duration::from_secs(1);

/// Path of a file that could not be written, and the system's error.
pub type NotSaved = (PathBuf, io::Error);

/// Keeps a file up to date. Without a path, it writes nothing.
#[derive(Debug)]
pub struct Saver<K> {
    path: Option<PathBuf>,
    runtime: tokio::runtime::Handle,
    text: fn(&K) -> io::Result<String>,
    kept: K,
    begun: Option<Duration>,
    under_way: Option<JoinHandle<Result<(), NotSaved>>>,
}

impl<K: Clone + PartialEq + Send + 'static> Saver<K> {
    /// `kept` is the content of the file, or content that needs no file; `text` serialises it.
    pub const fn new(
        path: Option<PathBuf>,
        runtime: tokio::runtime::Handle,
        kept: K,
        text: fn(&K) -> io::Result<String>,
    ) -> Self {
        Self {
            path,
            runtime,
            text,
            kept,
            begun: None,
            under_way: None,
        }
    }

    /// Starts a write if needed; `now` counts from any origin. Returns the error of an earlier write, which is not retried until
    /// the value changes again.
    ///
    /// # Errors
    /// [`NotSaved`].
    pub fn tick(&mut self, newest: &K, now: Duration) -> Result<(), NotSaved> {
        let ended = self.ended();
        let waits = self
            .begun
            .is_some_and(|begun| now.saturating_sub(begun) < SAVE_EVERY);
        if !waits {
            self.begin(newest, now);
        }
        ended
    }

    /// Writes pending changes at once. True if everything is on disk, or cannot be written.
    pub fn flush(&mut self, newest: &K, now: Duration) -> bool {
        let failed = self.ended().is_err();
        self.begin(newest, now);
        failed || self.under_way.is_none()
    }

    fn begin(&mut self, newest: &K, now: Duration) {
        let Some(path) = self.path.clone() else {
            return;
        };
        if self.under_way.is_some() || *newest == self.kept {
            return;
        }
        self.kept = newest.clone();
        let (kept, text) = (newest.clone(), self.text);
        let place = path.clone();
        let write = on_thread(move || replace_keeping_last(&place, &text(&kept)?));
        let write = async move { write.await.map_err(|error| (path, error)) };
        self.under_way = Some(self.runtime.spawn(write));
        self.begun = Some(now);
    }

    fn ended(&mut self) -> Result<(), NotSaved> {
        let ended = self
            .under_way
            .as_mut()
            .and_then(|write| write.now_or_never());
        let Some(ended) = ended else { return Ok(()) };
        self.under_way = None;
        // A write that panicked or was cancelled has no error of its own.
        ended.unwrap_or(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    async fn flushed(saver: &mut Saver<String>, newest: &str) {
        while !saver.flush(&newest.into(), Duration::ZERO) {
            tokio::task::yield_now().await;
        }
    }

    #[tokio::test]
    async fn only_changes_are_written_the_last_file_stays_and_a_failure_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/kept.toml");
        let runtime = tokio::runtime::Handle::current();
        let text = |kept: &String| Ok(kept.clone());
        let mut saver = Saver::new(Some(path.clone()), runtime.clone(), "one".into(), text);
        saver.tick(&"one".into(), Duration::ZERO).unwrap();
        assert!(saver.under_way.is_none(), "nothing changed");
        flushed(&mut saver, "two").await;
        flushed(&mut saver, "three").await;
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "three");
        let last = crate::store::file::last_of(&path);
        assert_eq!(std::fs::read_to_string(last).unwrap(), "two");
        let below = Some(path.join("below/a/file"));
        let mut saver = Saver::new(below, runtime, "one".into(), text);
        while saver.tick(&"two".into(), Duration::ZERO).is_ok() {
            tokio::task::yield_now().await;
        }
    }
}
