//! The folder that recordings go into: chosen by the user, and made if it is not there; and a recording shown in it by the system's
//! file manager.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::store::{BackgroundJob, create_folder, on_thread};
use std::future::ready;
use std::path::PathBuf;
use std::sync::Arc;

/// The folder that was typed, else one that is asked for. It exists once it is there.
pub(crate) fn choose(
    typed: Option<PathBuf>,
    env: &Env,
) -> BackgroundJob<Result<PathBuf, NoticeKind>> {
    let chosen = match typed {
        Some(path) => Box::pin(ready(Some(path))),
        None => env.files.folder(),
    };
    BackgroundJob::start(&env.runtime, &env.wake, async move {
        let path = chosen.await.ok_or(NoticeKind::NoFileChosen)?;
        let place = path.clone();
        let made = on_thread(move || {
            let place = std::path::absolute(place)?;
            create_folder(&place).map(|()| place)
        });
        let made = made.await;
        made.map_err(|error| NoticeKind::not_saved(path, &error))
    })
}

/// Shows a file; what to tell the user if that cannot be done.
pub(crate) fn reveal(path: PathBuf, env: &Env) -> BackgroundJob<Result<(), NoticeKind>> {
    let (reveal, place) = (Arc::clone(&env.reveal), path.clone());
    let shown = on_thread(move || {
        // A file manager that is asked for what is gone shows its own riddle, or nothing.
        std::fs::metadata(&place)?;
        reveal(&place)
    });
    let shown = async move {
        shown.await.map_err(|error| {
            let error = error.into();
            NoticeKind::NotRevealed { path, error }
        })
    };
    BackgroundJob::start(&env.runtime, &env.wake, shown)
}
