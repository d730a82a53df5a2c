//! Recordings on disk: their list, user requests, and the time line of the replayed one. The list is scanned in the
//! background; the summary of an unchanged file is reused. The recording being made is in [`recording`].

pub mod about;
pub mod budget;
pub mod export;
pub mod item;
pub mod recording;

pub use crate::app::recordings::about::{RecordingAbout, RecordingNote};
pub use crate::app::recordings::budget::PlannedDeletion;
pub use crate::app::recordings::export::{ExportProgress, RecordingExport};
pub use crate::app::recordings::item::RecordingItem;
pub use crate::app::recordings::recording::BesideRecording;

use crate::hand::Moment;
use crate::record::file::{FileMark, parts};
use crate::store::on_thread;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Maximum number of listed recordings: a few per working day for two years. Older ones are not listed.
pub const LISTED_MAX: usize = 2000;
/// Maximum number of remembered recordings of this run: one every few minutes of a working day. The oldest are dropped
/// first.
pub(crate) const OWN_MAX: usize = 100;
/// A file that is being recorded is read again after growing by one part in this many.
const GROWS_BY: u64 = 10;
/// Time shown before a replayed time range.
const LEAD_IN: Duration = Duration::from_secs(2);

/// A recording made since the program started.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnRecording {
    pub path: PathBuf,
    /// Endpoint of the hand, as text.
    pub hand: String,
    pub first: Moment,
    /// Last moment recorded so far.
    pub last: Moment,
}

impl OwnRecording {
    /// True if the recording contains this moment of the hand.
    pub(crate) fn holds(&self, hand: &str, at: Moment) -> bool {
        self.hand == hand && (self.first..=self.last).contains(&at)
    }
}

/// State of the recordings view.
#[derive(Debug, Default, Clone)]
pub struct RecordingsState {
    /// Recordings, newest first.
    pub items: Arc<Vec<RecordingItem>>,
    /// Folder of the recordings; `None` = none set.
    pub folder: Option<PathBuf>,
    /// True if the folder dialog returned no folder: the path can be typed instead.
    pub asks_folder: bool,
    /// True while a scan is running.
    pub is_scanning: bool,
    /// Unreadable files, with the reasons.
    pub unread: Arc<Vec<(PathBuf, String)>>,
    /// Recording whose deletion awaits confirmation.
    pub to_delete: Option<PathBuf>,
    /// Recordings over the storage budget, oldest first.
    pub planned: Vec<PlannedDeletion>,
    /// Files that are being recorded.
    pub recorded: Vec<PathBuf>,
    /// Recordings made since the program started, oldest first.
    pub own: Vec<OwnRecording>,
    /// Number of completed scans.
    pub scans: u64,
    /// Time of the last scan since 1970; defines today.
    pub scanned_at: Duration,
    /// Exports in progress.
    pub exports: Vec<ExportProgress>,
}

impl RecordingsState {
    /// Length of a recording; that of one being recorded by this program grows every frame.
    pub fn length(&self, item: &RecordingItem) -> Duration {
        let mut own = self.own.iter();
        let own = own.find(|own| own.path == item.path && self.recorded.contains(&own.path));
        own.map_or(item.length, |own| own.last.since(own.first))
    }
}

/// User requests concerning recordings.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum RecordingAction {
    /// Turn recording of hands on or off.
    Record(bool),
    /// Turn recording of built-in hands on or off.
    RecordSimulated(bool),
    /// Use this folder from the next recording on; without a path, ask the user for one.
    ChooseFolder(Option<PathBuf>),
    /// Use the user's documents folder again.
    DefaultFolder,
    /// Scan again.
    Refresh,
    /// Replay this file, from the list or elsewhere.
    Open(PathBuf),
    /// Replay this file in a loop between two moments, starting at the first.
    OpenAt(PathBuf, (Moment, Moment)),
    /// Return to the live hand.
    Close,
    /// Reveal this file in the system's file manager.
    Reveal(PathBuf),
    /// Export a recording, or a time range of it.
    Export(RecordingExport),
    /// Rename a recording; an empty name removes it.
    Name(PathBuf, String),
    /// Set or remove the star of a recording.
    Star(PathBuf, bool),
    /// Request confirmation to delete this recording.
    AskDelete(PathBuf),
    /// Delete the recording that awaits confirmation.
    Delete,
    /// Cancel the deletion.
    KeepIt,
    /// Delete the recordings over the storage budget now.
    MakeRoom,
    /// Star all recordings over the storage budget.
    KeepPlanned,
    /// Seek to this moment.
    Seek(Moment),
    /// Play or pause.
    Run(bool),
    /// Playback speed, 0.1 to 10.
    Pace(f32),
    /// Step to the next reading (true) or the previous one (false).
    Step(bool),
    /// Loop over this time range, or play all once.
    Loop(Option<(Moment, Moment)>),
    /// Overlay this recording on the replayed one, or remove the overlay.
    Beside(Option<PathBuf>),
    /// Align the overlay: this moment of the replayed recording with that moment of the other.
    Align(Moment, Moment),
    /// Edit the note at a moment; an empty text removes it.
    EditNote(Moment, String),
}

/// Contents of the time line of a replayed recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Timeline {
    pub path: PathBuf,
    /// User-given name, else the file name.
    pub title: String,
    /// Start time, in the format of [`RecordingItem::began`].
    pub began: String,
    /// Endpoint of the hand, as text.
    pub hand: String,
    pub first: Moment,
    pub last: Moment,
    /// Moment that is shown.
    pub at: Moment,
    /// True while playing.
    pub runs: bool,
    /// Playback speed, 1 = real time.
    pub pace: f32,
    /// Time range that is looped.
    pub looped: Option<(Moment, Moment)>,
    /// Events in the recording.
    pub marks: Arc<Vec<FileMark>>,
    /// Effective notes.
    pub notes: Arc<Vec<RecordingNote>>,
    /// Maximum force over the length.
    pub strip: Arc<Vec<f32>>,
    /// True while the requested moment is not shown yet.
    pub waits: bool,
    /// True if a part of the file cannot be read.
    pub damaged: bool,
    /// True if the live hand is armed, moving, or has a fault; shown next to the button that returns to it.
    pub live_needs_eyes: bool,
}

/// Action that replays a time range of a hand in a loop, with a short lead-in; `None` if no recording contains its start.
pub fn replay_of(
    recordings: &RecordingsState,
    replayed: Option<&Timeline>,
    hand: &str,
    (from, to): (Moment, Moment),
) -> Option<RecordingAction> {
    let before = Moment::from_duration(from.since(Moment::ZERO).saturating_sub(LEAD_IN));
    let (path, first) = match replayed {
        Some(line) => (line.first..=line.last)
            .contains(&from)
            .then_some((&line.path, line.first)),
        None => {
            let mut own = recordings.own.iter();
            let own = own.rfind(|own| own.holds(hand, from));
            own.map(|own| (&own.path, own.first))
        }
    }?;
    Some(RecordingAction::OpenAt(
        path.clone(),
        (before.max(first), to),
    ))
}

/// Result of a scan.
#[derive(Debug)]
pub(crate) struct FolderListing {
    pub(crate) items: Vec<RecordingItem>,
    pub(crate) unread: Vec<(PathBuf, String)>,
    /// Previously announced deletions.
    pub(crate) announced: Vec<PlannedDeletion>,
}

/// Scans this folder and its day folders for recordings.
pub(crate) async fn scan(folder: PathBuf, known: Arc<Vec<RecordingItem>>) -> FolderListing {
    let found = on_thread(move || Ok(find(&folder, &known))).await;
    found.unwrap_or(FolderListing {
        items: Vec::new(),
        unread: Vec::new(),
        announced: Vec::new(),
    })
}

fn find(folder: &Path, known: &[RecordingItem]) -> FolderListing {
    let mut recordings = parts::recordings(parts::files(folder));
    recordings.sort_by(|one, two| two.cmp(one));
    recordings.truncate(LISTED_MAX);
    let (mut items, mut unread) = (Vec::new(), Vec::new());
    for files in recordings {
        let sizes = files.iter().flat_map(std::fs::metadata);
        let bytes = sizes.map(|about| about.len()).sum::<u64>();
        let same = |item: &&RecordingItem| item.files == files && is_known(item, bytes);
        if let Some(item) = known.iter().find(same) {
            let about = RecordingAbout::load(&item.path).unwrap_or_default();
            items.push(RecordingItem {
                about,
                ..item.clone()
            });
            continue;
        }
        let (item, refused) = RecordingItem::read(&files);
        items.extend(item);
        unread.extend(
            refused
                .into_iter()
                .map(|(path, why)| (path, why.to_string())),
        );
    }
    items.sort_by_key(|item| std::cmp::Reverse(item.opening.began_since_1970()));
    FolderListing {
        items,
        unread,
        announced: budget::load_announced(folder),
    }
}

/// True if files of this total size need not be read again: the recording is closed and unchanged, or still open and has
/// grown only a little. An open recording has to be read whole.
fn is_known(item: &RecordingItem, bytes: u64) -> bool {
    if item.closed {
        return item.bytes == bytes;
    }
    let grew = bytes.saturating_sub(item.bytes);
    let goes_on = |last: &PathBuf| is_ended(last).is_ok_and(|ended| !ended);
    grew < item.bytes / GROWS_BY && item.files.last().is_some_and(goes_on)
}

/// True if the last 8 bytes equal the first 8, the mark of a closed MCAP file.
fn is_ended(path: &Path) -> io::Result<bool> {
    let mut file = File::open(path)?;
    let (mut first, mut last) = ([0; 8], [0; 8]);
    file.read_exact(&mut first)?;
    file.seek(SeekFrom::End(-8))?;
    file.read_exact(&mut last)?;
    Ok(first == last)
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn second(at: u64) -> Moment {
        Moment::from_micros(at * 1_000_000)
    }

    #[test]
    fn the_session_that_holds_the_moment_of_that_hand_is_opened_two_seconds_before() {
        let own = |name: &str, hand: &str, first, last| OwnRecording {
            path: name.into(),
            hand: hand.into(),
            first: second(first),
            last: second(last),
        };
        let recordings = RecordingsState {
            own: vec![
                own("a", "x", 10, 20),
                own("b", "y", 10, 20),
                own("c", "x", 30, 40),
            ],
            ..RecordingsState::default()
        };
        let check = |hand: &str, from, wanted: Option<(&str, u64)>| {
            let stretch = (second(from), second(50));
            let wanted = wanted.map(|(name, first)| {
                RecordingAction::OpenAt(name.into(), (second(first), second(50)))
            });
            assert_eq!(
                replay_of(&recordings, None, hand, stretch),
                wanted,
                "{hand} {from}"
            );
        };
        check("x", 15, Some(("a", 13)));
        check("y", 15, Some(("b", 13)));
        check("x", 11, Some(("a", 10)));
        check("x", 25, None);
        check("x", 40, Some(("c", 38)));
        check("z", 15, None);
    }
}
