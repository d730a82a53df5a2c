//! Choice of the recordings folder, created if missing; and revealing a recording in the system's file manager.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::store::{create_folder, on_thread};
use std::future::ready;
use std::path::PathBuf;
use std::sync::Arc;

/// Returns the typed folder or asks the user for one, and creates it if missing.
pub(crate) fn choose(
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
