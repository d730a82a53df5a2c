//! Reads a second session, to be drawn over the one that is replayed. Off the window's thread.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::app::replay::recorded::Recorded;
use crate::app::sessions::BesideSession;
use crate::app::sessions::about::SessionAbout;
use crate::app::sessions::item::SessionItem;
use crate::hand::Moment;
use crate::record::file::{OpenError, SessionFile};
use crate::store::{BackgroundJob, on_thread};
use std::path::PathBuf;

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
        history: recorded.hand.measured.history,
        own,
        other: file.first(),
    })
}
