//! Files of poses on disk: read at start and for import, bounded, off the window's thread. Knows no setpoint.

use crate::app::config::{Kept, set_aside};
use crate::app::notices::NoticeKind;
use crate::app::poses::file::{self, PoseFileCause, PoseFileError};
use crate::app::poses::library::Library;
use crate::app::save::ChooseFile;
use crate::link::Wake;
use std::io::Read;
use std::path::{Path, PathBuf};
use tokio::sync::oneshot;

/// Five hundred poses are a quarter of this; anything longer is not a file of poses.
const FILE_LEN_MAX: u64 = 1024 * 1024;
/// The file's name, beside the settings and for export.
pub const FILE_NAME: &str = "handscope-poses.toml";

/// Where poses lie, beside these settings.
#[must_use]
pub fn path_beside(settings: &Path) -> PathBuf {
    settings.with_file_name("poses.toml")
}

/// Reads a file of poses.
///
/// # Errors
/// [`PoseFileError`]: what cannot be read, and where.
pub fn read(path: &Path) -> Result<Library, PoseFileError> {
    let unreadable = |error: std::io::Error| PoseFileCause::Unreadable(error.to_string());
    let about = std::fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        return Err(PoseFileCause::Unreadable("it is not a file".into()).into());
    }
    let (got, limit) = (about.len(), FILE_LEN_MAX);
    if got > limit {
        return Err(PoseFileCause::TooLong { got, limit }.into());
    }
    let mut text = String::new();
    let opened = std::fs::File::open(path).map_err(unreadable)?;
    opened
        .take(limit)
        .read_to_string(&mut text)
        .map_err(unreadable)?;
    file::read(&text)
}

/// The library that was kept, and what a person should know about its file. An unreadable file is put aside and the
/// last good one taken.
#[must_use]
pub fn load(path: &Path) -> (Library, Option<NoticeKind>) {
    if !path.exists() {
        return (Library::default(), None);
    }
    match read(path) {
        Ok(library) => (library, None),
        Err(error) => {
            let last = path.with_extension("last.toml");
            let library = read(&last).unwrap_or_default();
            let kept_as = set_aside(path);
            (library, Some(NoticeKind::PosesIgnored { error, kept_as }))
        }
    }
}

/// A file of poses that is being chosen and read.
#[derive(Debug)]
pub(crate) struct Reading(oneshot::Receiver<Result<Library, NoticeKind>>);

impl Reading {
    /// Asks for a file and reads it, on the runtime. `wake` is called at the end.
    pub(crate) fn start(
        files: &dyn ChooseFile,
        runtime: &tokio::runtime::Handle,
        wake: Wake,
    ) -> Self {
        let (told, ended) = oneshot::channel();
        let chosen = files.open(FILE_NAME);
        runtime.spawn(async move {
            let end = match chosen.await {
                None => Err(NoticeKind::NoFileChosen),
                Some(path) => read_away(path).await,
            };
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = told.send(end);
            wake();
        });
        Self(ended)
    }

    /// How it ended, once it has: what was read, or what to tell.
    pub(crate) fn ended(&mut self) -> Option<Result<Library, NoticeKind>> {
        match self.0.try_recv() {
            Ok(end) => Some(end),
            Err(oneshot::error::TryRecvError::Empty) => None,
            Err(oneshot::error::TryRecvError::Closed) => Some(Err(NoticeKind::NoFileChosen)),
        }
    }
}

async fn read_away(path: PathBuf) -> Result<Library, NoticeKind> {
    let place = path.clone();
    let read = match tokio::task::spawn_blocking(move || read(&place)).await {
        Ok(read) => read,
        Err(error) => Err(PoseFileCause::Unreadable(error.to_string()).into()),
    };
    read.map_err(|error| NoticeKind::PosesRefused { path, error })
}

impl Kept for Library {
    fn text(&self) -> std::io::Result<String> {
        file::write(self).map_err(std::io::Error::other)
    }

    fn not_saved(message: String) -> NoticeKind {
        NoticeKind::PosesNotSaved { message }
    }
}
