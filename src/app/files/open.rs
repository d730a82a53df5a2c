//! Opens a file chosen by the user, off the window's thread, and sets unreadable files aside.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::store::{FileError, on_thread, set_aside};
use std::future::ready;
use std::path::{Path, PathBuf};

/// Reads the file at the typed path, else asks the user for one, suggesting this name.
pub(crate) fn open<T, R>(
    typed: Option<PathBuf>,
    suggested: &str,
    env: &Env,
    read: R,
) -> impl Future<Output = Result<T, NoticeKind>> + Send + use<T, R>
where
    T: Send + 'static,
    R: FnOnce(&Path) -> Result<T, FileError> + Send + 'static,
{
    let chosen = match typed {
        Some(path) => Box::pin(ready(Some(path))),
        None => env.files.open(suggested),
    };
    async move {
        let path = chosen.await.ok_or(NoticeKind::NoFileChosen)?;
        let place = path.clone();
        let read = on_thread(move || Ok(read(&place))).await;
        let read = read.unwrap_or_else(|error| Err(error.into()));
        read.map_err(|error| NoticeKind::FileRefused { path, error })
    }
}

/// Sets an unreadable file of this program aside, unchanged.
pub(crate) fn put_aside(path: &Path, error: FileError) -> NoticeKind {
    NoticeKind::FileIgnored {
        path: path.to_owned(),
        error,
        kept_as: set_aside(path),
    }
}
