//! Files of the program: settings, poses, and exports. Here: opening a file or folder that the user chooses, and revealing a
//! file, off the window's thread; and setting an unreadable file aside.

pub mod export;
pub mod pose_file;
pub mod settings_file;

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::store::{FileError, create_folder, on_thread, set_aside};
use std::future::ready;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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

/// Returns the typed folder or asks the user for one, and creates it if missing.
pub(crate) fn choose_folder(
    typed: Option<PathBuf>,
    env: &Env,
) -> impl Future<Output = Result<PathBuf, NoticeKind>> + Send + use<> {
    let chosen = match typed {
        Some(path) => Box::pin(ready(Some(path))),
        None => env.files.folder(),
    };
    async move {
        let path = chosen.await.ok_or(NoticeKind::NoFileChosen)?;
        let place = path.clone();
        let made = on_thread(move || {
            let place = std::path::absolute(place)?;
            create_folder(&place).map(|()| place)
        });
        let made = made.await;
        made.map_err(|error| NoticeKind::not_saved(path, &error))
    }
}

/// Reveals a file in the file manager; an error carries the notice for the user.
pub(crate) fn reveal(
    path: PathBuf,
    env: &Env,
) -> impl Future<Output = Result<(), NoticeKind>> + Send + use<> {
    let (reveal, place) = (Arc::clone(&env.reveal), path.clone());
    let shown = on_thread(move || {
        // A file manager given a missing path shows a cryptic error, or nothing.
        std::fs::metadata(&place)?;
        reveal(&place)
    });
    async move {
        shown.await.map_err(|error| {
            let error = error.into();
            NoticeKind::NotRevealed { path, error }
        })
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
