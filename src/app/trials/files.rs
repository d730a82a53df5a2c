//! Trial session folders: chosen, written and read off the window's thread. The formats are defined in [`crate::trials::session`].

use crate::app::env::Env;
use crate::app::env::day_folder;
use crate::app::files::open as open_file;
use crate::app::notices::NoticeKind;
use crate::app::trials::state::{
    SessionId, SessionOrigin, SessionTrial, TrialSession, TrialsState,
};
use crate::store;
use crate::store::calendar::stamp;
use crate::store::{FileCause, FileError, on_thread, read_text};
use crate::trials::recording::csv;
use crate::trials::session::{SESSION_FILE, SessionHead, load};
use crate::trials::session_writer::TrialSessionWriter;
use crate::trials::{Criterion, TrialRecording, TrialSummary};
use futures::FutureExt as _;
use futures::future::BoxFuture;
use std::future::ready;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::time::Duration;

/// Maximum size of a samples table in bytes. A longer one is not from this program: a trial holds fewer rows.
const TABLE_LEN_MAX: u64 = 256 * 1024 * 1024;

/// Result of a file operation, or the notice for the user.
pub(crate) type FilesEnd = Result<FilesDone, NoticeKind>;

/// A completed file operation.
#[derive(Debug)]
pub(crate) enum FilesDone {
    /// A session was saved to a folder, with its number of trials.
    Saved(SessionId, PathBuf, usize),
    /// A session was read.
    Opened(PathBuf, Box<TrialSession>),
}

/// Asks for a folder and writes a session that was run here into a new folder inside it.
pub(crate) fn save(
    session: &TrialSession,
    criterion: Option<Criterion>,
    env: &Env,
) -> Option<impl Future<Output = FilesEnd> + Send + use<>> {
    let is_own = !matches!(session.origin, SessionOrigin::Folder(_));
    is_own.then(|| save_in(session.clone(), criterion, env.files.folder()))
}

/// Saves without asking: an unsaved session into a new folder in the folder of its day; of a saved one, the note and
/// tags.
pub(crate) fn keep(session: &TrialSession, env: &Env) -> Option<BoxFuture<'static, FilesEnd>> {
    match &session.origin {
        SessionOrigin::Folder(_) => None,
        SessionOrigin::Saved(folder) => Some(keep_words(session, folder.clone()).boxed()),
        SessionOrigin::Unsaved => {
            let documents = env.documents.as_deref()?;
            let folder = day_folder::of_day(documents, &session.head.day);
            let folder = Box::pin(ready(Some(folder)));
            (!session.trials.is_empty()).then(|| save_in(session.clone(), None, folder).boxed())
        }
    }
}

/// Reads the session folder at the typed path, else asks for its `session.toml`.
pub(crate) fn open(
    typed: Option<PathBuf>,
    env: &Env,
) -> impl Future<Output = FilesEnd> + Send + use<> {
    open_file(typed, SESSION_FILE, env, |path| {
        let folder = if path.is_dir() {
            path
        } else {
            path.parent().unwrap_or(Path::new("."))
        };
        let session = Box::new(read_session(folder)?);
        Ok(FilesDone::Opened(path.to_owned(), session))
    })
}

/// Writes a session into a new folder inside the chosen one.
async fn save_in(
    session: TrialSession,
    criterion: Option<Criterion>,
    chosen: BoxFuture<'static, Option<PathBuf>>,
) -> FilesEnd {
    let folder = chosen.await.ok_or(NoticeKind::NoFileChosen)?;
    let name = folder_name(&session.head);
    let (id, trials) = (session.id, session.trials.len());
    let asked = folder.join(&name);
    let work = move || {
        // Two series that start in the same second get separate folders.
        let place = day_folder::free_path(&folder, &name);
        write(session, &place, criterion).map(|()| place)
    };
    let written = on_thread(work).await;
    let folder = written.map_err(|error| NoticeKind::not_saved(asked, &error))?;
    Ok(FilesDone::Saved(id, folder, trials))
}

/// Updates the note and tags in a session's file.
fn keep_words(
    session: &TrialSession,
    folder: PathBuf,
) -> impl Future<Output = FilesEnd> + Send + use<> {
    let (id, trials) = (session.id, session.trials.len());
    let (note, tags) = (session.head.note.clone(), session.head.tags.clone());
    async move {
        let place = folder.clone();
        let work = move || {
            let mut file = load(&place)?;
            (file.head.note, file.head.tags) = (note, tags);
            let text = toml::to_string(&file).map_err(io::Error::other)?;
            store::replace(&place.join(SESSION_FILE), text.as_bytes())
        };
        match on_thread(work).await {
            Ok(()) => Ok(FilesDone::Saved(id, folder, trials)),
            Err(error) => Err(NoticeKind::not_saved(folder, &error)),
        }
    }
}

/// Folder name `handscope-trials-2026-11-21-123456`, in UTC.
fn folder_name(head: &SessionHead) -> String {
    let begun = stamp(Duration::from_secs(head.begun_unix_s));
    let (_, time) = begun.split_once('T').unwrap_or_default();
    let digits: String = time.chars().filter(char::is_ascii_digit).collect();
    format!("handscope-trials-{}-{digits}", head.day)
}

/// Writes the same files as the command line.
fn write(session: TrialSession, folder: &Path, criterion: Option<Criterion>) -> io::Result<()> {
    let mut head = session.head;
    let aborted = head.aborted.take();
    let mut writer = TrialSessionWriter::create(folder, head, criterion)?;
    for trial in &session.trials {
        writer.add(&trial.summary, &trial.recording)?;
    }
    writer.finish(aborted)
}

/// Reads a session folder. A missing samples table leaves its trial without lines; a damaged one rejects the session.
fn read_session(folder: &Path) -> Result<TrialSession, FileError> {
    let file = load(folder)?;
    let trial = |summary: TrialSummary| {
        let samples = samples(folder, summary.samples.as_deref());
        let number = summary.number;
        let samples = samples.map_err(|error| error.of_named(format!("trial {number}")));
        Ok(SessionTrial::read(summary, &samples?.unwrap_or_default()))
    };
    let trials: Result<Vec<SessionTrial>, FileError> = file.trials.into_iter().map(trial).collect();
    Ok(TrialSession {
        id: SessionId(0),
        head: file.head,
        origin: SessionOrigin::Folder(folder.to_owned()),
        trials: trials?,
        lost: 0,
    })
}

/// Samples of a trial; `None` if the file is missing. Names that lead out of the folder are rejected.
fn samples(folder: &Path, name: Option<&str>) -> Result<Option<TrialRecording>, FileError> {
    let Some(name) = name else { return Ok(None) };
    let mut parts = Path::new(name).components();
    let (Some(Component::Normal(_)), None) = (parts.next(), parts.next()) else {
        let got = format!("'{name}'");
        return Err(FileCause::Outside { got }.into());
    };
    let text = read_text(&folder.join(name), TABLE_LEN_MAX).map_err(FileError::from);
    let table = text.and_then(|text| text.map(|text| csv::read(&text)).transpose());
    table.map_err(|error| error.of_named(format!("'{name}'")))
}

impl TrialsState {
    /// Applies the result of a file operation and returns its notice.
    pub(crate) fn apply(&mut self, end: FilesEnd) -> NoticeKind {
        self.refused = end.as_ref().err().cloned();
        match end {
            Err(notice) => notice,
            Ok(FilesDone::Saved(id, path, entries)) => {
                if let Some(session) = self.session_mut(id) {
                    session.origin = SessionOrigin::Saved(path.clone());
                }
                NoticeKind::Saved { path, entries }
            }
            Ok(FilesDone::Opened(path, session)) => {
                let trials = session.trials.len();
                self.add(session.head, session.origin, session.trials);
                NoticeKind::RecordingOpened { path, trials }
            }
        }
    }
}
