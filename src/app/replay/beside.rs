//! Reads a second recording, to be overlaid on the replayed one, in the background.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::app::recordings::BesideRecording;
use crate::app::recordings::about::RecordingAbout;
use crate::app::recordings::item::RecordingItem;
use crate::app::replay::recorded::Recorded;
use crate::hand::Moment;
use crate::record::file::{OpenError, RecordingFile};
use crate::store::{BackgroundJob, on_thread};
use std::path::PathBuf;

/// Reads a recording and aligns its start with this moment.
pub(crate) fn read(
    path: PathBuf,
    own: Moment,
    env: &Env,
) -> BackgroundJob<Result<BesideRecording, NoticeKind>> {
    let read = async move {
        let place = path.clone();
        let read = on_thread(move || Ok(open(&place, own))).await;
        let read = read.unwrap_or_else(|error| Err(error.into()));
        read.map_err(|why| NoticeKind::RecordingRefused { path, why })
    };
    BackgroundJob::start(&env.runtime, &env.wake, read)
}

fn open(path: &std::path::Path, own: Moment) -> Result<BesideRecording, OpenError> {
    let file = RecordingFile::open(path)?;
    let recorded = Recorded::whole(&file)?;
    let item = RecordingItem::of(&file, RecordingAbout::load(path).unwrap_or_default());
    Ok(BesideRecording {
        title: item.title(),
        first: file.first(),
        marks: item.marks,
        history: recorded.hand.measured.history,
        own,
        other: file.first(),
    })
}
