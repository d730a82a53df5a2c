//! Place of the results, and the selection in their comparison. Holds no trial.

use crate::app::trials::{SessionId, TrialSession};

/// A trial of a session, by its index.
pub(crate) type TrialKey = (SessionId, usize);

/// Place of the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ResultsPlace {
    /// Beside the plan, which shows what a search found with its actions.
    BesidePlan,
    /// Alone, with a button that opens the plan.
    Alone,
}

/// The sessions shown, and the current one, whose words and files can be edited.
#[derive(Debug, Default)]
pub(crate) struct ShownSessions {
    /// Overlaid sessions, the oldest first.
    pub(crate) shown: Vec<SessionId>,
    pub(crate) focus: Option<SessionId>,
    newest: Option<SessionId>,
}

impl ShownSessions {
    /// Shows a newly begun or opened session at once, and drops sessions that no longer exist.
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

    /// Makes a session the current one; shown alone, unless it is already shown with others.
    pub(crate) fn choose(&mut self, id: SessionId) {
        if !self.shown.contains(&id) {
            self.shown = vec![id];
        }
        self.focus = Some(id);
    }

    /// Adds a session to the overlaid ones or removes it. The last one remains.
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
