//! Events marked by a line across all plots. Bounded.

use crate::hand::Moment;
use crate::hand::grip::Tightened;
use std::collections::VecDeque;
use std::sync::Arc;

/// Maximum number of marks: one every two seconds for an hour, more than the user can read.
pub const MARKS_MAX: usize = 2048;
/// Maximum length of a note in characters: one line of the window.
pub const NOTE_MAX: usize = 80;

/// Kind of event.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum MarkKind {
    Armed,
    /// Disarmed, other than by a stop, a fault or a lost link.
    Disarmed,
    /// Stop was pressed.
    Stop,
    /// Stop was pressed, and could not be sent.
    StopNotSent,
    /// Feedback confirmed that the hand is at rest.
    HoldConfirmed,
    /// A drive reported a fault: joint and fault by their stable names, `index: stall`.
    Fault(Arc<str>),
    /// The hand stopped answering.
    LinkLost,
    /// The hand answers again.
    Reconnected,
    /// A gesture was started; its number.
    Gesture(u8),
    /// A finger of a hold pressed harder.
    Tightened(Tightened),
    /// A note by the user, at most [`NOTE_MAX`] characters on one line.
    Note(Arc<str>),
}

impl MarkKind {
    /// A note with this text, cut to one line of [`NOTE_MAX`] characters; `None` if nothing is left.
    pub fn note(words: &str) -> Option<Self> {
        let line: String = words
            .trim()
            .lines()
            .next()?
            .chars()
            .take(NOTE_MAX)
            .collect();
        (!line.is_empty()).then(|| Self::Note(line.into()))
    }

    /// Stable lower-case name for files; a note and a fault are followed by their text, a gesture by its number.
    pub fn words(&self) -> String {
        match self {
            Self::Armed => "armed".into(),
            Self::Disarmed => "disarmed".into(),
            Self::Stop => "stop".into(),
            Self::StopNotSent => "stop not sent".into(),
            Self::HoldConfirmed => "at rest".into(),
            Self::Fault(words) => format!("fault: {words}"),
            Self::LinkLost => "link lost".into(),
            Self::Reconnected => "reconnected".into(),
            Self::Gesture(number) => format!("gesture {number}"),
            Self::Tightened(own) => {
                format!("tightened: {}, {}", own.finger.name(), own.cause.name())
            }
            Self::Note(words) => format!("note: {words}"),
        }
    }
}

/// One event on the time axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    pub at: Moment,
    pub kind: MarkKind,
}

/// The newest marks, oldest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marks(VecDeque<Mark>);

impl Marks {
    pub(crate) fn push(&mut self, mark: Mark) {
        if self.0.len() >= MARKS_MAX {
            self.0.pop_front();
        }
        // A note is placed at the moment its key was pressed, which may precede other marks.
        let place = self.0.partition_point(|before| before.at <= mark.at);
        self.0.insert(place, mark);
    }

    pub(crate) fn remove(&mut self, mark: &Mark) {
        self.0.retain(|kept| kept != mark);
    }

    pub(crate) fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Mark> {
        self.0
            .iter()
            .filter(move |mark| (from_s..=to_s).contains(&mark.at.secs()))
    }
}
