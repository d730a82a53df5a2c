//! Comparison of trials across sessions: rows, lines, scores of the settings, and whether sessions may be pooled.
//! Computed on change, not every frame. Draws nothing.

use crate::app::trials::state::{
    JointLines, SessionId, SessionTrial, TrialQuantity, TrialSession, TrialsState,
};
use crate::hand::Dof;
use crate::history::decimated;
use crate::trials::best::{Score, best, scores};
use crate::trials::session::SessionHead;
use crate::trials::{Criterion, JointMetrics, TrialSetting, TrialSummary};

/// Maximum number of sessions shown at once: the number of distinguishable line styles.
pub const SHOWN_MAX: usize = 4;
/// Maximum number of lines drawn at once; more are unreadable.
pub const LINES_MAX: usize = 200;
/// Maximum number of points over all drawn lines: a few milliseconds per frame without a graphics card.
pub const POINTS_MAX: usize = 20_000;

/// Key of a table row: one joint of one trial of a shown session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RowKey {
    /// Index of the session, 0 = oldest.
    pub session: usize,
    /// Index of the trial in the session.
    pub trial: usize,
    /// Index of the joint among those that took part.
    pub joint: usize,
}

/// Contents of a row.
#[derive(Debug, Clone, Copy)]
pub struct ComparedRow<'a> {
    pub session: &'a TrialSession,
    pub trial: &'a TrialSummary,
    /// Metrics of the joint.
    pub joint: &'a JointMetrics,
}

/// Property by which lines are coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineGroup {
    /// By joint, if several took part.
    Joint(Dof),
    /// By setting: its index in the sorted settings.
    Setting(usize),
    /// By session, if all tried the same setting.
    Session(usize),
}

/// Reason why sessions are not pooled: their numbers are not comparable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionDifference {
    /// Different hands, or the same hand at different endpoints.
    Hand,
    /// Different joints.
    Joints,
    /// Different start or target angles.
    Way,
    /// Different approaches.
    Approach,
    /// Different hold times.
    Dwell,
}

impl SessionDifference {
    /// All differences, in display order.
    const ALL: [Self; 5] = [
        Self::Hand,
        Self::Joints,
        Self::Way,
        Self::Approach,
        Self::Dwell,
    ];
}

#[derive(Debug, Clone, PartialEq)]
pub struct ComparedLine {
    pub key: RowKey,
    /// Time of contact with the object, s.
    pub contact_s: Option<f64>,
    /// Points of (seconds since the command, value).
    pub points: Vec<[f64; 2]>,
}

/// Lines to draw.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ComparedLines {
    /// Lines, oldest first.
    pub lines: Vec<ComparedLine>,
    /// Total number of available lines.
    pub all: usize,
}

/// Comparison of several sessions.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    of: Vec<(SessionId, usize)>,
    focus: SessionId,
    several_joints: bool,
    /// One row per joint per trial, in order.
    pub rows: Vec<RowKey>,
    /// Settings tried, sorted.
    pub settings: Vec<TrialSetting>,
    /// Joints that were tried in the sessions being scored.
    pub joints: Vec<Dof>,
    /// Scores of the settings, over all sessions or over one: see [`Self::differences`].
    pub scores: Vec<Score>,
    /// Reasons why scores do not cover all sessions; empty if they do.
    pub differences: Vec<SessionDifference>,
    /// Best score by the last criterion passed to [`Self::judge`], or that of [`Self::found`].
    pub best: Option<Score>,
    /// Setting that a search found in the trials of the focused session: the only one to recommend.
    pub found: Option<TrialSetting>,
}

/// State used to detect changes: trials are added to a session but never modified.
fn revision(trials: &TrialsState, shown: &[SessionId]) -> Vec<(SessionId, usize)> {
    let mut of: Vec<_> = shown
        .iter()
        .filter_map(|id| Some((*id, trials.session(*id)?.trials.len())))
        .collect();
    of.sort_unstable();
    of.dedup();
    of.truncate(SHOWN_MAX);
    of
}

impl Comparison {
    /// Compares these sessions. If they cannot be pooled, scores cover `focus` alone.
    pub fn of(trials: &TrialsState, shown: &[SessionId], focus: SessionId) -> Self {
        let of = revision(trials, shown);
        let sessions: Vec<&TrialSession> = of
            .iter()
            .filter_map(|(id, _)| trials.session(*id))
            .collect();
        let own = trials.session(focus);
        let differences = differences(&sessions);
        let pooled: Vec<&TrialSession> = if differences.is_empty() {
            sessions.clone()
        } else {
            own.into_iter().collect()
        };
        let mut settings: Vec<TrialSetting> = summaries(&sessions).map(|own| own.setting).collect();
        settings.sort_unstable();
        settings.dedup();
        Self {
            rows: rows(&sessions),
            several_joints: summaries(&sessions).any(|own| own.joints.len() > 1)
                || differences.contains(&SessionDifference::Joints),
            settings,
            joints: joints(&pooled),
            scores: scores(summaries(&pooled)),
            differences,
            best: None,
            found: None,
            focus,
            of,
        }
    }

    /// Selects the best score: that of the setting which a search found in the focused session, else the best by this criterion.
    pub fn judge(&mut self, trials: &TrialsState, criterion: Criterion) {
        let search = trials.search.as_ref();
        let search = search.filter(|search| search.session == self.focus);
        let finding = search.and_then(|search| search.finding.as_ref());
        let claim = finding.and_then(|finding| finding.result.as_ref().ok());
        self.found = claim.map(|claim| claim.setting);
        let scores = &self.scores;
        self.best = match self.found {
            Some(setting) => scores.iter().find(|score| score.setting == setting),
            None => best(scores, criterion),
        }
        .cloned();
    }

    /// True if this setting has the best score.
    pub fn is_best(&self, setting: TrialSetting) -> bool {
        let best = self.best.as_ref();
        best.is_some_and(|best| best.setting == setting)
    }

    /// True while recomputing would give the same result.
    pub fn is_current(&self, trials: &TrialsState, shown: &[SessionId], focus: SessionId) -> bool {
        self.focus == focus && self.of == revision(trials, shown)
    }

    /// IDs of the sessions, oldest first.
    pub fn sessions(&self) -> impl ExactSizeIterator<Item = SessionId> + DoubleEndedIterator {
        self.of.iter().map(|(id, _)| *id)
    }

    /// Contents of a row; `None` if its session or trial no longer exists.
    pub fn row<'a>(&self, trials: &'a TrialsState, key: RowKey) -> Option<ComparedRow<'a>> {
        let (session, trial) = self.trial(trials, key)?;
        let joint = trial.summary.joints.get(key.joint)?;
        Some(ComparedRow {
            session,
            trial: &trial.summary,
            joint,
        })
    }

    fn trial<'a>(
        &self,
        trials: &'a TrialsState,
        key: RowKey,
    ) -> Option<(&'a TrialSession, &'a SessionTrial)> {
        let (id, _) = self.of.get(key.session)?;
        let session = trials.session(*id)?;
        Some((session, session.trials.get(key.trial)?))
    }

    /// Colour group of a row.
    pub fn group(&self, key: RowKey, row: ComparedRow<'_>) -> LineGroup {
        if self.several_joints {
            return LineGroup::Joint(row.joint.dof);
        }
        if self.of.len() > 1 && self.settings.len() == 1 {
            return LineGroup::Session(key.session);
        }
        let at = self.settings.binary_search(&row.trial.setting);
        LineGroup::Setting(at.unwrap_or_default())
    }

    /// Lines of a quantity: a uniform selection of all, decimated to the visible resolution. The lines of the
    /// highlighted trial `strong` are always included, last and with all their points.
    pub fn lines(
        &self,
        trials: &TrialsState,
        quantity: TrialQuantity,
        strong: Option<(SessionId, usize)>,
    ) -> ComparedLines {
        let line = |key: &RowKey| {
            let (session, trial) = self.trial(trials, *key)?;
            let line = trial.lines.get(key.joint)?;
            let is_strong = strong == Some((session.id, trial.summary.number));
            Some((is_strong, *key, line)).filter(|_| !line.points(quantity).is_empty())
        };
        let (strong, others): (Vec<_>, Vec<_>) = self
            .rows
            .iter()
            .filter_map(line)
            .partition(|(is_strong, ..)| *is_strong);
        let all = strong.len() + others.len();
        let count = others.len().min(LINES_MAX);
        let most = POINTS_MAX / count.max(1);
        let chosen = (0..count).filter_map(|at| others.get(at * others.len() / count));
        let drawn = |(is_strong, key, line): &(bool, RowKey, &JointLines)| ComparedLine {
            key: *key,
            contact_s: line.contact_s,
            points: if *is_strong {
                line.points(quantity).to_vec()
            } else {
                decimated(line.points(quantity), most)
            },
        };
        ComparedLines {
            lines: chosen.chain(&strong).map(drawn).collect(),
            all,
        }
    }
}

fn rows(sessions: &[&TrialSession]) -> Vec<RowKey> {
    let mut rows = Vec::new();
    for (session, own) in sessions.iter().enumerate() {
        for (trial, own) in own.trials.iter().enumerate() {
            let joints = 0..own.summary.joints.len();
            rows.extend(joints.map(|joint| RowKey {
                session,
                trial,
                joint,
            }));
        }
    }
    rows
}

fn summaries<'a>(sessions: &[&'a TrialSession]) -> impl Iterator<Item = &'a TrialSummary> {
    let trials = sessions.iter().flat_map(|session| &session.trials);
    trials.map(|trial| &trial.summary)
}

fn joints(sessions: &[&TrialSession]) -> Vec<Dof> {
    let tried = |dof: &Dof| {
        let mut joints = summaries(sessions).flat_map(|trial| &trial.joints);
        joints.any(|joint| joint.dof == *dof)
    };
    Dof::ALL.into_iter().filter(tried).collect()
}

fn differences(sessions: &[&TrialSession]) -> Vec<SessionDifference> {
    let Some((first, others)) = sessions.split_first() else {
        return Vec::new();
    };
    let first = &first.head;
    let same_joints = |own: &SessionHead| own.plan.joints().eq(first.plan.joints());
    let differs = |difference: SessionDifference, own: &SessionHead| match difference {
        SessionDifference::Hand => own.hand != first.hand,
        SessionDifference::Joints => !same_joints(own),
        SessionDifference::Way => {
            same_joints(own)
                && (own.plan.start, own.plan.close) != (first.plan.start, first.plan.close)
        }
        SessionDifference::Approach => own.plan.approach != first.plan.approach,
        SessionDifference::Dwell => own.plan.dwell != first.plan.dwell,
    };
    let any =
        |difference: &SessionDifference| others.iter().any(|own| differs(*difference, &own.head));
    SessionDifference::ALL.into_iter().filter(any).collect()
}
