//! A second session, drawn over the one that is replayed: both are aligned by a moment of each.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::app::sessions::about::SessionAbout;
use crate::app::sessions::item::SessionItem;
use crate::app::sessions::replay::Recorded;
use crate::hand::Moment;
use crate::history::History;
use crate::record::file::{FileMark, OpenError, SessionFile};
use crate::store::{BackgroundJob, on_thread};
use std::path::PathBuf;

/// A session that is drawn over another.
#[derive(Debug)]
pub struct BesideSession {
    /// Its name, or that of its file.
    pub title: String,
    pub first: Moment,
    /// What happened.
    pub marks: Vec<FileMark>,
    /// What was measured.
    pub history: History,
    /// The moment of the replayed session at which both are aligned.
    pub own: Moment,
    /// The moment of this session.
    pub other: Moment,
}

impl BesideSession {
    /// Seconds from the times of the replayed session to those of this one.
    pub fn offset_s(&self) -> f64 {
        self.other.secs() - self.own.secs()
    }
}

/// Reads a session, to be aligned at its beginning with this moment.
pub(crate) fn read(
    path: PathBuf,
    own: Moment,
    env: &Env,
) -> BackgroundJob<Result<BesideSession, NoticeKind>> {
    let read = async move {
        let place = path.clone();
        let read = on_thread(move || Ok(open(&place, own))).await;
        let read = read.unwrap_or_else(|error| Err(error.into()));
        read.map_err(|why| NoticeKind::SessionRefused { path, why })
    };
    BackgroundJob::start(&env.runtime, &env.wake, read)
}

fn open(path: &std::path::Path, own: Moment) -> Result<BesideSession, OpenError> {
    let file = SessionFile::open(path)?;
    let recorded = Recorded::whole(&file)?;
    let item = SessionItem::of(&file, SessionAbout::load(path).unwrap_or_default());
    Ok(BesideSession {
        title: item.title(),
        first: file.first(),
        marks: item.marks,
        history: recorded.hand.history,
        own,
        other: file.first(),
    })
}
