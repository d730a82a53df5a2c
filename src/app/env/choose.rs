//! How the user is asked where a file is or should go.

use futures::future::BoxFuture;
use std::path::PathBuf;

/// Asks the user where a file should go. Called on the window's thread; what it gives is awaited elsewhere.
pub trait ChooseFile: Send + Sync + 'static {
    /// Resolves to the chosen place; `None` if there was no choice. `suggested` is a file name.
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to a file that is there, to be read; `None` if there was no choice.
    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to a folder that is there, to put another into; `None` if there was no choice.
    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>>;
}

/// Where nobody can be asked: nothing is ever chosen.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoChoice;

impl ChooseFile for NoChoice {
    fn choose(&self, _suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }

    fn open(&self, _suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }

    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }
}
