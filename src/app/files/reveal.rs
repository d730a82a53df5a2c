//! Showing a file where it lies, in the system's file manager. How that is started is the shell's matter.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::store::{BackgroundJob, on_thread};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Shows a file in the system's file manager. Called off the window's thread; comes back once it is known whether that began.
pub type Reveal = Arc<dyn Fn(&Path) -> io::Result<()> + Send + Sync>;

/// Where there is no file manager: says so.
#[must_use]
pub fn no_reveal() -> Reveal {
    Arc::new(|_| Err(io::Error::other("there is no file manager")))
}

/// Shows a file; what to tell a person if that cannot be done.
pub(crate) fn reveal(path: PathBuf, env: &Env) -> BackgroundJob<Result<(), NoticeKind>> {
    let (reveal, place) = (Arc::clone(&env.reveal), path.clone());
    let shown = on_thread(move || {
        // A file manager that is asked for what is gone shows its own riddle, or nothing.
        std::fs::metadata(&place)?;
        reveal(&place)
    });
    let shown = async move {
        shown.await.map_err(|error| {
            let message = error.to_string();
            NoticeKind::NotRevealed { path, message }
        })
    };
    BackgroundJob::start(&env.runtime, &env.wake, shown)
}
