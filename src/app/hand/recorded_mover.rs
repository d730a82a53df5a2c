//! What a recording tells of who moves the hand, beside the status of its link.

use crate::link::LinkStatus;

/// Who moves the hand, as the events of a recording tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct RecordedMover {
    /// The trial, and how many there are, in the arming of then.
    pub(crate) trial: Option<(usize, usize)>,
}

impl RecordedMover {
    /// A trial began, as its words say: `2 of 4`, and then the joints.
    pub(crate) fn begin_trial(&mut self, words: &str) {
        let numbers = words.split(", ").next();
        let numbers = numbers.and_then(|numbers| numbers.split_once(" of "));
        self.trial =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    }

    /// The link's status changed: no series goes on without arming.
    pub(crate) fn take_status(&mut self, link: &LinkStatus) {
        self.trial = self.trial.filter(|_| link.armed.is_some());
    }
}
