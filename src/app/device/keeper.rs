//! The files of what a hand keeps, off the window's thread: the backup and the note before a SAVE, the note after it, the record that is
//! shown, files that are compared. Decides nothing about the hand.

use crate::app::calendar::since_1970;
use crate::app::desk::Desk;
use crate::app::device::book::SaveEnd;
use crate::app::device::compared::Compared;
use crate::app::notices::NoticeKind;
use crate::app::params::file::{self, ParamsFile, ParamsFileError};
use crate::app::params::record::{Backup, Known, Record, folder_beside};
use crate::app::params::values::Params;
use crate::app::save::ChooseFile;
use crate::link::{NotSent, Saved, Wake};
use crate::transport::Endpoint;
use futures::future::BoxFuture;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use tokio::sync::oneshot;

/// The result of a SAVE that another program sent may come this late.
const APART: Duration = Duration::from_secs(6);

/// Something to be done with the record of the hand.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FileJob {
    /// Keep these as a backup, and note that a SAVE goes out.
    Before(Params),
    /// Note what came of it.
    After(Saved),
}

/// What came of the backup and the note; without them no SAVE goes out.
pub(crate) type Before = Result<(), SaveEnd>;

/// What is kept of a hand.
#[derive(Debug)]
struct Kept {
    known: Result<Known, ParamsFileError>,
    backups: io::Result<Vec<Backup>>,
}

#[derive(Debug)]
enum Done {
    Loaded(Kept),
    Before(Before),
    After(Result<(), String>, Kept),
}

/// Does one thing after another for the hand of now.
pub(crate) struct DeviceKeeper {
    folder: Option<PathBuf>,
    runtime: tokio::runtime::Handle,
    wake: Wake,
    started: SystemTime,
    loaded: Option<Endpoint>,
    under_way: Option<(Endpoint, oneshot::Receiver<Done>)>,
    opening: Option<oneshot::Receiver<Result<(PathBuf, ParamsFile), NoticeKind>>>,
}

impl DeviceKeeper {
    /// Keeps the records beside the settings; without settings nowhere.
    pub(crate) fn new(
        settings: Option<&Path>,
        runtime: tokio::runtime::Handle,
        wake: Wake,
    ) -> Self {
        Self {
            folder: settings.map(folder_beside),
            runtime,
            wake,
            started: SystemTime::now(),
            loaded: None,
            under_way: None,
            opening: None,
        }
    }

    /// Takes in what ended and begins what is to be done; what a person should know.
    pub(crate) fn tick(&mut self, desk: &mut Desk) -> Option<NoticeKind> {
        self.finished(desk);
        self.begin(desk);
        self.opened(desk)
    }

    fn begin(&mut self, desk: &mut Desk) {
        let hand = desk.state.endpoint.clone();
        if hand.is_none() {
            self.loaded = None;
        }
        let (Some(folder), Some(hand), None) = (&self.folder, hand, &self.under_way) else {
            return;
        };
        let record = Record::new(folder, &hand);
        let is_new = self.loaded.as_ref() != Some(&hand) || desk.state.device.folder.is_none();
        if is_new {
            // The built-in hand begins as it was delivered: whatever was saved in an earlier one is gone.
            let forgets = hand.is_sim() && self.loaded.as_ref() != Some(&hand);
            desk.state.device.folder = Some(record.folder().into());
            self.loaded = Some(hand.clone());
            self.run(hand, move || {
                if forgets {
                    // What cannot be forgotten is shown with its date.
                    let _forgotten = record.forget_saved();
                }
                Done::Loaded(kept(&record))
            });
            return;
        }
        let started = self.started;
        match desk.work.files.take() {
            None => {}
            Some(FileJob::Before(params)) => {
                self.run(hand, move || {
                    Done::Before(before(&record, &params, started))
                });
            }
            Some(FileJob::After(saved)) => self.run(hand, move || {
                let noted = record.end(&saved).map_err(|error| error.to_string());
                Done::After(noted, kept(&record))
            }),
        }
    }

    fn run(&mut self, hand: Endpoint, work: impl FnOnce() -> Done + Send + 'static) {
        let (told, under_way) = oneshot::channel();
        let wake = self.wake.clone();
        self.runtime.spawn_blocking(move || {
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = told.send(work());
            wake();
        });
        self.under_way = Some((hand, under_way));
    }

    fn finished(&mut self, desk: &mut Desk) {
        let Some((hand, under_way)) = &mut self.under_way else {
            return;
        };
        let done = match under_way.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return,
            Err(oneshot::error::TryRecvError::Closed) => None,
            Ok(done) => Some(done),
        };
        let is_of_now = desk.state.endpoint.as_ref() == Some(hand);
        self.under_way = None;
        let now = desk.state.now;
        match done.filter(|_| is_of_now) {
            None => {}
            Some(Done::Loaded(kept)) => show(desk, kept),
            Some(Done::Before(end)) => desk.backed_up(end, now),
            Some(Done::After(noted, kept)) => {
                show(desk, kept);
                desk.noted(noted, now);
            }
        }
    }

    /// Asks for a file of parameters and reads it. One dialog at a time.
    pub(crate) fn open(&mut self, files: &dyn ChooseFile) {
        self.read(files.open(FILE_NAME));
    }

    /// Reads a backup.
    pub(crate) fn open_backup(&mut self, path: PathBuf) {
        self.read(Box::pin(std::future::ready(Some(path))));
    }

    fn read(&mut self, chosen: BoxFuture<'static, Option<PathBuf>>) {
        if self.opening.is_some() {
            return;
        }
        let (told, opening) = oneshot::channel();
        let wake = self.wake.clone();
        self.runtime.spawn(async move {
            let end = match chosen.await {
                None => Err(NoticeKind::NoFileChosen),
                Some(path) => load(path).await,
            };
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = told.send(end);
            wake();
        });
        self.opening = Some(opening);
    }

    fn opened(&mut self, desk: &mut Desk) -> Option<NoticeKind> {
        let end = match self.opening.as_mut()?.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return None,
            Err(oneshot::error::TryRecvError::Closed) => Err(NoticeKind::NoFileChosen),
            Ok(end) => end,
        };
        self.opening = None;
        match end {
            Err(refused) => Some(refused),
            Ok((path, file)) => {
                let name = path.file_name().unwrap_or_default();
                let name = name.to_string_lossy().into_owned();
                let book = &mut desk.state.device;
                book.compared = Some(Compared::new(name, file, &book.live_params()));
                None
            }
        }
    }
}

/// The name that is suggested for a file of parameters.
pub(crate) const FILE_NAME: &str = "handscope-params.toml";

async fn load(path: PathBuf) -> Result<(PathBuf, ParamsFile), NoticeKind> {
    let place = path.clone();
    let read = tokio::task::spawn_blocking(move || file::load(&place)).await;
    let read = read.unwrap_or_else(|error| Err(ParamsFileError::Unreadable(error.to_string())));
    match read {
        Ok(file) => Ok((path, file)),
        Err(error) => Err(NoticeKind::ParamsRefused { path, error }),
    }
}

fn before(record: &Record, params: &Params, started: SystemTime) -> Before {
    let now = SystemTime::now();
    let own = now.duration_since(started).unwrap_or_default();
    // The link itself keeps those of this program apart.
    let other = record
        .since_attempt(now)
        .filter(|ago| *ago < APART && *ago > own);
    if let Some(ago) = other {
        let wait = APART.saturating_sub(ago);
        return Err(SaveEnd::Told(Saved::NotSent(NotSent::TooSoon { wait })));
    }
    let at = since_1970();
    let backed_up = record.back_up(params, "before save", at);
    let noted = backed_up.and_then(|_| record.attempt(params, at));
    noted.map_err(|error| SaveEnd::NoBackup {
        message: error.to_string(),
    })
}

fn kept(record: &Record) -> Kept {
    Kept {
        known: record.known(),
        backups: record.backups(),
    }
}

fn show(desk: &mut Desk, kept: Kept) {
    let book = &mut desk.state.device;
    let unreadable = |error: io::Error| ParamsFileError::Unreadable(error.to_string());
    book.unreadable = None;
    match kept.known {
        Ok(known) => book.known = known,
        Err(error) => {
            book.known = Known::default();
            book.unreadable = Some(error);
        }
    }
    match kept.backups {
        Ok(backups) => book.backups = backups,
        Err(error) => book.unreadable = Some(unreadable(error)),
    }
}
