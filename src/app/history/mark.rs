//! Moments worth a line across all plots. Bounded.

use crate::hand::Moment;
use std::collections::VecDeque;

/// Marks that are kept: a person makes about one every few seconds at most, for ten minutes.
pub const MARKS_MAX: usize = 512;

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MarkKind {
    /// The hand was armed.
    Armed,
    /// Stop was pressed.
    Stop,
    /// Feedback showed that the hand rests.
    HoldConfirmed,
    /// A drive reported a fault.
    Fault,
    /// The hand fell silent.
    LinkLost,
    /// The hand answers again.
    Reconnected,
    /// A gesture was started, by number.
    Gesture(u8),
}

/// One moment worth a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    /// When.
    pub at: Moment,
    /// What.
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
        self.0.push_back(mark);
    }

    pub(crate) fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Mark> {
        self.0
            .iter()
            .filter(move |mark| (from_s..=to_s).contains(&mark.at.secs()))
    }
}
