//! A second recording, drawn over the one that is replayed: both are aligned by a moment of each.

use crate::hand::Moment;
use crate::history::History;
use crate::record::file::FileMark;

/// A recording that is drawn over another.
#[derive(Debug)]
pub struct BesideRecording {
    /// Its name, or that of its file.
    pub title: String,
    pub first: Moment,
    /// What happened.
    pub marks: Vec<FileMark>,
    /// What was measured.
    pub history: History,
    /// The moment of the replayed recording at which both are aligned.
    pub own: Moment,
    /// The moment of this recording.
    pub other: Moment,
}

impl BesideRecording {
    /// Seconds from the times of the replayed recording to those of this one.
    pub fn offset_s(&self) -> f64 {
        self.other.secs() - self.own.secs()
    }
}
