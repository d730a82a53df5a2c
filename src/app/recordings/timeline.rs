//! What the time line of a replayed recording shows.

use crate::app::recordings::about::RecordingNote;
use crate::hand::Moment;
use crate::record::file::FileMark;
use std::path::PathBuf;
use std::sync::Arc;

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
