//! Which recordings there are. They are looked for off the window's thread, and what was read of a file that did not change is kept.

use crate::app::env::Env;
use crate::app::recordings::about::RecordingNote;
use crate::app::recordings::budget::{self, PlannedDeletion};
use crate::app::recordings::export::{ExportProgress, RecordingExport};
use crate::app::recordings::item::RecordingItem;
use crate::hand::Moment;
use crate::record::file::{FileMark, parts};
use crate::store::{BackgroundJob, on_thread};
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Recordings that are listed: some for each working day of two years. Beyond, the oldest are not.
pub const SESSIONS_MAX: usize = 2000;
/// Recordings of this run of the program that are remembered: one each few minutes of a working day. The oldest go first.
pub(crate) const OWN_MAX: usize = 100;
/// A file that is being recorded is read again once it grew by this part of itself.
const GROWS_BY: u64 = 10;

/// A recording made since the program began.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnRecording {
    /// The file.
    pub path: PathBuf,
    /// The hand, in the spelling of endpoints.
    pub hand: String,
    /// When it began.
    pub first: Moment,
    /// Until when it was recorded, as of now.
    pub last: Moment,
}

impl OwnRecording {
    /// True if it holds this moment of a hand.
    pub(crate) fn holds(&self, hand: &str, at: Moment) -> bool {
        self.hand == hand && (self.first..=self.last).contains(&at)
    }
}

/// What the view of recordings shows.
#[derive(Debug, Default, Clone)]
pub struct RecordingsState {
    /// The newest first.
    pub items: Arc<Vec<RecordingItem>>,
    /// Where they lie; `None` = nowhere.
    pub folder: Option<PathBuf>,
    /// No folder was chosen in a dialog: its path can be typed.
    pub asks_folder: bool,
    /// They are being looked for.
    pub looks: bool,
    /// Files there that could not be read, and why.
    pub unread: Arc<Vec<(PathBuf, String)>>,
    /// The recording that is to be deleted, once the user agrees.
    pub to_delete: Option<PathBuf>,
    /// What the budget has no room for, the oldest first.
    pub planned: Vec<PlannedDeletion>,
    /// Files that are being recorded.
    pub recorded: Vec<PathBuf>,
    /// What was recorded since the program began, the oldest first.
    pub own: Vec<OwnRecording>,
    /// Counts how often they were looked for.
    pub looked: u64,
    /// The time since 1970 when that was done last: what is today.
    pub looked_at: Duration,
    /// What is being written in formats of others.
    pub exports: Vec<ExportProgress>,
}

impl RecordingsState {
    /// How long a recording is; one that this program records grows from frame to frame.
    pub fn length(&self, item: &RecordingItem) -> Duration {
        let mut own = self.own.iter();
        let own = own.find(|own| own.path == item.path && self.recorded.contains(&own.path));
        own.map_or(item.length, |own| own.last.since(own.first))
    }
}

/// What looking for recordings found.
#[derive(Debug)]
pub(crate) struct Looked {
    pub(crate) items: Vec<RecordingItem>,
    pub(crate) unread: Vec<(PathBuf, String)>,
    /// What was told before of recordings that are to make room.
    pub(crate) told: Vec<PlannedDeletion>,
}

/// Looks for recordings in this folder and the folders of days in it.
pub(crate) fn look(
    folder: PathBuf,
    known: Arc<Vec<RecordingItem>>,
    env: &Env,
) -> BackgroundJob<Looked> {
    let look = async move {
        let found = on_thread(move || Ok(find(&folder, &known))).await;
        found.unwrap_or(Looked {
            items: Vec::new(),
            unread: Vec::new(),
            told: Vec::new(),
        })
    };
    BackgroundJob::start(&env.runtime, &env.wake, look)
}

fn find(folder: &Path, known: &[RecordingItem]) -> Looked {
    let mut recordings = parts::recordings(parts::files(folder));
    recordings.sort_by(|one, two| two.cmp(one));
    recordings.truncate(SESSIONS_MAX);
    let (mut items, mut unread) = (Vec::new(), Vec::new());
    for files in recordings {
        let sizes = files.iter().flat_map(std::fs::metadata);
        let bytes = sizes.map(|about| about.len()).sum::<u64>();
        let same = |item: &&RecordingItem| item.files == files && is_known(item, bytes);
        if let Some(item) = known.iter().find(same) {
            let about =
                crate::app::recordings::RecordingAbout::load(&item.path).unwrap_or_default();
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
    Looked {
        items,
        unread,
        told: budget::load_told(folder),
    }
}

/// True if files of this size in all need not be read again: they were ended, or grew little since and go on. What goes on is
/// read whole.
fn is_known(item: &RecordingItem, bytes: u64) -> bool {
    if item.closed {
        return item.bytes == bytes;
    }
    let grew = bytes.saturating_sub(item.bytes);
    let goes_on = |last: &PathBuf| is_ended(last).is_ok_and(|ended| !ended);
    grew < item.bytes / GROWS_BY && item.files.last().is_some_and(goes_on)
}

/// True if a file ends as it begins: MCAP files that were ended do.
fn is_ended(path: &Path) -> io::Result<bool> {
    let mut file = File::open(path)?;
    let (mut first, mut last) = ([0; 8], [0; 8]);
    file.read_exact(&mut first)?;
    file.seek(SeekFrom::End(-8))?;
    file.read_exact(&mut last)?;
    Ok(first == last)
}

/// What the user asks about recordings.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum RecordingAction {
    /// Record hands from now on, or no longer.
    Record(bool),
    /// Record built-in hands, too, or no longer.
    RecordSimulated(bool),
    /// Record into this folder from the next recording on; without a path the user is asked for one.
    ChooseFolder(Option<PathBuf>),
    /// Record into the user's documents again.
    DefaultFolder,
    /// Look again which recordings there are.
    Look,
    /// Replay this file: one of the list, or any other.
    Open(PathBuf),
    /// Replay this file from the first of two moments on, the stretch between them again and again.
    OpenAt(PathBuf, (Moment, Moment)),
    /// Go back to the live hand.
    Close,
    /// Show where this file lies, in the system's file manager.
    Reveal(PathBuf),
    /// Write a recording, or a stretch of it, in a format of others.
    Export(RecordingExport),
    /// Give a recording a name; empty takes it away.
    Name(PathBuf, String),
    /// Give a recording a star, or take it away.
    Star(PathBuf, bool),
    /// Ask whether this recording is to be deleted.
    AskDelete(PathBuf),
    /// Delete the recording that was asked about.
    Delete,
    /// Delete nothing.
    KeepIt,
    /// Delete what the budget has no room for, now.
    MakeRoom,
    /// Give a star to all that the budget has no room for.
    KeepPlanned,
    /// Show this moment.
    Seek(Moment),
    /// Let time go on, or stop it.
    Run(bool),
    /// How fast time goes, 0.1 to 10.
    Pace(f32),
    /// Go to the next reading, or to the one before.
    Step(bool),
    /// Play this stretch again and again, or all once.
    Loop(Option<(Moment, Moment)>),
    /// Draw this recording over the replayed one, or none any more.
    Beside(Option<PathBuf>),
    /// Align both: this moment of the replayed recording with that moment of the other.
    Align(Moment, Moment),
    /// Change the words of the note at a moment; of no words, take it away.
    EditNote(Moment, String),
}

/// What the time line of a replayed recording shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Timeline {
    /// The file.
    pub path: PathBuf,
    /// The recording's name, or that of its file.
    pub title: String,
    /// When it began, as [`RecordingItem::began`](crate::app::recordings::RecordingItem::began) tells it.
    pub began: String,
    /// The hand's endpoint.
    pub hand: String,
    pub first: Moment,
    pub last: Moment,
    /// The moment that is shown.
    pub at: Moment,
    /// Time goes on.
    pub runs: bool,
    /// How fast.
    pub pace: f32,
    /// The stretch that is played again and again.
    pub looped: Option<(Moment, Moment)>,
    /// What happened.
    pub marks: Arc<Vec<FileMark>>,
    /// The notes in force.
    pub notes: Arc<Vec<RecordingNote>>,
    /// Greatest force over its length.
    pub strip: Arc<Vec<f32>>,
    /// The moment that was asked for is not shown yet.
    pub waits: bool,
    /// Whether a part of the file cannot be read.
    pub damaged: bool,
    /// The live hand behind it is armed, moves, or has a fault: said beside the way back.
    pub live_needs_eyes: bool,
}
