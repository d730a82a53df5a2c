//! What is chosen in the comparison. Holds no trial.

use crate::app::trials::{SessionId, TrialSession};

/// A trial of a session, by its number.
pub(crate) type TrialKey = (SessionId, usize);

/// The sessions that are shown, and the one whose words and files are at hand.
#[derive(Debug, Default)]
pub(crate) struct ShownSessions {
    /// Over each other, the oldest first.
    pub(crate) shown: Vec<SessionId>,
    pub(crate) focus: Option<SessionId>,
    newest: Option<SessionId>,
}

impl ShownSessions {
    /// What was begun or opened last is shown at once; what is not there any more is not.
    pub(crate) fn follow(&mut self, sessions: &[TrialSession]) {
        let newest = sessions.iter().map(|session| session.id).max();
        let is_new = newest > self.newest;
        self.newest = newest.max(self.newest);
        self.shown
            .retain(|id| sessions.iter().any(|own| own.id == *id));
        if is_new || self.shown.is_empty() {
            self.shown = newest.into_iter().collect();
        }
        let is_shown = |id: &SessionId| self.shown.contains(id);
        self.focus = self.focus.filter(is_shown);
        self.focus = self.focus.or(self.shown.last().copied());
    }

    /// Makes a session the one at hand; alone, unless it is shown with others.
    pub(crate) fn choose(&mut self, id: SessionId) {
        if !self.shown.contains(&id) {
            self.shown = vec![id];
        }
        self.focus = Some(id);
    }

    /// Puts a session over the others or takes it away. The last one stays.
    pub(crate) fn toggle(&mut self, id: SessionId) {
        if !self.shown.contains(&id) {
            self.shown.push(id);
            self.shown.sort_unstable();
        } else if self.shown.len() > 1 {
            self.shown.retain(|own| *own != id);
            self.focus = self.focus.filter(|focus| *focus != id);
        }
    }
}
