//! Sessions in folders: asked for, written and read away from the window's thread. The formats are in [`crate::app::trial::session`].

use crate::app::notices::NoticeKind;
use crate::app::save::ChooseFile;
use crate::app::trial::metrics::TrialMetrics;
use crate::app::trial::session::{self, Head, Keeper, SESSION_FILE, SessionFile, TrialRow};
use crate::app::trial::{Abort, Criterion, Recording, Setting, Trial, TrialPlan, read};
use crate::app::tuner::book::{Ended, Origin, Session, SessionId, Tried, TunerBook};
use crate::app::tuner::lines::Lines;
use crate::hand::{Force, Speed};
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::oneshot;

/// A table of samples that is longer is not ours: a trial holds fewer rows.
const TABLE_LEN_MAX: u64 = 256 * 1024 * 1024;
/// Seconds of a day.
const DAY_S: u64 = 86_400;

/// How it ended.
#[derive(Debug)]
pub(crate) enum FilesEnd {
    /// A session was written there.
    Saved(SessionId, PathBuf, usize),
    /// A session was read.
    Opened(PathBuf, Box<Session>),
    /// Neither.
    Not(NoticeKind),
}

/// Files that are being asked for, written or read.
#[derive(Debug)]
pub(crate) struct Files(oneshot::Receiver<FilesEnd>);

/// What is written, apart from the session that goes on.
struct Parcel {
    id: SessionId,
    head: Head,
    plan: TrialPlan,
    trials: Vec<Arc<Trial>>,
    aborted: Option<Abort>,
    criterion: Option<Criterion>,
}

impl Files {
    /// Asks for a folder and writes a session that was run here into a new one inside it.
    pub(crate) fn save(
        session: &Session,
        criterion: Option<Criterion>,
        files: &dyn ChooseFile,
        runtime: &tokio::runtime::Handle,
        wake: crate::link::Wake,
    ) -> Option<Self> {
        let Origin::Here { plan, .. } = &session.origin else {
            return None;
        };
        let parcel = Parcel {
            id: session.id,
            head: session.head.clone(),
            plan: TrialPlan::clone(plan),
            trials: session
                .trials
                .iter()
                .filter_map(|own| own.whole.clone())
                .collect(),
            aborted: match session.ended {
                Some(Ended::Here(why)) => Some(why),
                _ => None,
            },
            criterion,
        };
        let chosen = files.folder();
        Some(Self::start(runtime, wake, async move {
            let Some(folder) = chosen.await else {
                return FilesEnd::Not(NoticeKind::NoFileChosen);
            };
            let folder = folder.join(folder_name(parcel.head.begun));
            let (id, place) = (parcel.id, folder.clone());
            let work = move || parcel.write(&place);
            match tokio::task::spawn_blocking(work)
                .await
                .map_err(io::Error::other)
            {
                Ok(Ok(trials)) => FilesEnd::Saved(id, folder, trials),
                Ok(Err(error)) | Err(error) => FilesEnd::Not(NoticeKind::NotSaved {
                    path: folder,
                    message: error.to_string(),
                }),
            }
        }))
    }

    /// Asks for the `session.toml` of a session and reads its folder.
    pub(crate) fn open(
        files: &dyn ChooseFile,
        runtime: &tokio::runtime::Handle,
        wake: crate::link::Wake,
    ) -> Self {
        let chosen = files.open(SESSION_FILE);
        Self::start(runtime, wake, async move {
            let Some(file) = chosen.await else {
                return FilesEnd::Not(NoticeKind::NoFileChosen);
            };
            let path = file.clone();
            let work = move || read(file.parent().unwrap_or(Path::new(".")));
            match tokio::task::spawn_blocking(work)
                .await
                .map_err(io::Error::other)
            {
                Ok(Ok(session)) => FilesEnd::Opened(path, Box::new(session)),
                Ok(Err(error)) | Err(error) => FilesEnd::Not(NoticeKind::SessionRefused {
                    path,
                    message: error.to_string(),
                }),
            }
        })
    }

    fn start(
        runtime: &tokio::runtime::Handle,
        wake: crate::link::Wake,
        work: impl Future<Output = FilesEnd> + Send + 'static,
    ) -> Self {
        let (told, ended) = oneshot::channel();
        runtime.spawn(async move {
            let end = work.await;
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = told.send(end);
            wake();
        });
        Self(ended)
    }

    /// How it ended, once it has.
    pub(crate) fn ended(&mut self) -> Option<FilesEnd> {
        match self.0.try_recv() {
            Ok(end) => Some(end),
            Err(oneshot::error::TryRecvError::Empty) => None,
            Err(oneshot::error::TryRecvError::Closed) => {
                Some(FilesEnd::Not(NoticeKind::NoFileChosen))
            }
        }
    }
}

/// `handscope-trials-2026-11-21-123456`, in universal time.
fn folder_name(begun: Duration) -> String {
    let day = crate::app::calendar::day(begun);
    let of_day = begun.as_secs() % DAY_S;
    let (hours, minutes) = (of_day / 3600, of_day / 60 % 60);
    format!(
        "handscope-trials-{day}-{hours:02}{minutes:02}{:02}",
        of_day % 60
    )
}

impl Parcel {
    /// The same files as those of the command line; how many trials.
    fn write(&self, folder: &Path) -> io::Result<usize> {
        let mut keeper = Keeper::create(folder, &self.head, &self.plan, self.criterion)?;
        for trial in &self.trials {
            keeper.keep(trial)?;
        }
        keeper.close(self.aborted)?;
        Ok(self.trials.len())
    }
}

/// Reads a session's folder. A table of samples that is not there leaves its trial without lines; a spoilt one refuses all.
pub(crate) fn read(folder: &Path) -> io::Result<Session> {
    let file = session::load(folder)?;
    let rows = file.trials.iter();
    let trials: io::Result<Vec<Tried>> = rows.map(|row| tried(folder, row)).collect();
    let trials = trials?;
    Ok(Session {
        id: SessionId(0),
        head: head(&file),
        origin: Origin::Folder {
            path: folder.to_owned(),
            plan: Box::new(file.plan),
        },
        trials,
        ended: file.aborted.map(Ended::Told),
        lost: 0,
    })
}

fn head(file: &SessionFile) -> Head {
    Head {
        hand: file.hand.clone(),
        simulated: file.simulated,
        begun: Duration::from_secs(file.begun_unix_s),
        note: file.note.clone(),
        tags: file.tags.clone(),
        quirks: file.quirks.clone(),
    }
}

fn tried(folder: &Path, row: &TrialRow) -> io::Result<Tried> {
    let wrong = |what: String| io::Error::other(format!("trial {}: {what}", row.number));
    let metrics = TrialMetrics {
        joints: row.joints.clone(),
    };
    let recording = samples(folder, &row.samples).map_err(|error| wrong(error.to_string()))?;
    let setting = Setting {
        speed: Speed::new(row.speed).map_err(|error| wrong(error.to_string()))?,
        force: Force::new(row.force_threshold_g).map_err(|error| wrong(error.to_string()))?,
    };
    Ok(Tried {
        number: row.number,
        repeat: match row.kind.as_str() {
            "probe" => None,
            _ => Some(row.repeat.unwrap_or(1)),
        },
        setting,
        lines: Lines::of(&recording.unwrap_or_default(), &metrics),
        metrics,
        ended: row.aborted.clone().map(Ended::Told),
        whole: None,
    })
}

/// The samples of a trial; none if the file is not there. No name leads out of the folder.
fn samples(folder: &Path, name: &str) -> io::Result<Option<Recording>> {
    let mut parts = Path::new(name).components();
    let (Some(Component::Normal(_)), None) = (parts.next(), parts.next()) else {
        return Err(io::Error::other(format!(
            "'{name}' is no file of this folder"
        )));
    };
    let path = folder.join(name);
    let length = match std::fs::metadata(&path) {
        Ok(about) => about.len(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    if length > TABLE_LEN_MAX {
        return Err(io::Error::other(format!("'{name}' is too long")));
    }
    let text = std::fs::read_to_string(&path)?;
    let table = read::recording(&text);
    table
        .map(Some)
        .map_err(|error| io::Error::other(format!("'{name}', {error}")))
}

impl TunerBook {
    /// Takes in what became of files, and what to tell of it.
    pub(crate) fn take(&mut self, end: FilesEnd) -> NoticeKind {
        match end {
            FilesEnd::Not(told) => told,
            FilesEnd::Saved(id, path, entries) => {
                if let Some(session) = self.session_mut(id)
                    && let Origin::Here { saved, .. } = &mut session.origin
                {
                    *saved = Some(path.clone());
                }
                NoticeKind::Saved { path, entries }
            }
            FilesEnd::Opened(path, session) => {
                let trials = session.trials.len();
                let id = self.add(session.head, session.origin, session.trials);
                if let Some(kept) = self.session_mut(id) {
                    kept.ended = session.ended;
                }
                NoticeKind::SessionOpened { path, trials }
            }
        }
    }
}
