//! Reads a second recording, to be overlaid on the replayed one, off the window's thread.

use crate::app::notices::NoticeKind;
use crate::app::recordings::BesideRecording;
use crate::app::recordings::about::RecordingAbout;
use crate::app::recordings::item::RecordingItem;
use crate::app::replay::recorded::Recorded;
use crate::hand::Moment;
use crate::record::file::{OpenError, RecordingFile};
use crate::store::on_thread;
use std::path::PathBuf;

/// Reads a recording and aligns its start with this moment.
pub(crate) async fn read(path: PathBuf, own: Moment) -> Result<BesideRecording, NoticeKind> {
    let place = path.clone();
    let read = on_thread(move || Ok(open(&place, own))).await;
    let read = read.unwrap_or_else(|error| Err(error.into()));
    read.map_err(|why| NoticeKind::RecordingRefused { path, why })
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
