//! Trials of several sessions side by side: rows, lines, what the settings come to, and whether they may be taken
//! together. Reckoned when something changed, not each frame. Draws nothing.

use crate::app::trials::lines::{JointLines, TrialQuantity};
use crate::app::trials::state::{SessionId, SessionTrial, TrialSession, TrialsState};
use crate::hand::Dof;
use crate::history::decimated;
use crate::trials::best::{Score, best, scores};
use crate::trials::session::SessionHead;
use crate::trials::{Criterion, JointMetrics, TrialSetting, TrialSummary};

/// Sessions that are shown at once: as many as there are kinds of strokes that an eye tells apart.
pub const SHOWN_MAX: usize = 4;
/// Lines that are drawn at once; more are a carpet.
pub const LINES_MAX: usize = 200;
/// Points of all lines that are drawn at once: some milliseconds a frame without a graphics card.
pub const POINTS_MAX: usize = 20_000;

/// One row of the table: one joint of one trial of a session that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RowKey {
    /// Which of the sessions shown, 0 the oldest.
    pub session: usize,
    /// Which of its trials, from 0.
    pub trial: usize,
    /// Which of the joints that took part, from 0.
    pub joint: usize,
}

/// What stands in a row.
#[derive(Debug, Clone, Copy)]
pub struct ComparedRow<'a> {
    pub session: &'a TrialSession,
    pub trial: &'a TrialSummary,
    /// What was measured.
    pub joint: &'a JointMetrics,
}

/// What lines have a colour for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineGroup {
    /// The joint, where several took part.
    Joint(Dof),
    /// The setting, in the order of settings.
    Setting(usize),
    /// The session, where all tried the same setting.
    Session(usize),
}

/// Why sessions are not taken together: their numbers do not tell the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionDifference {
    /// Another hand, or the same at another place.
    Hand,
    /// Other joints.
    Joints,
    /// Another start or target.
    Way,
    /// Another approach.
    Approach,
    /// Held for another time.
    Dwell,
}

impl SessionDifference {
    /// All, in the order in which they are told.
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
    /// When it met the object, s.
    pub contact_s: Option<f64>,
    /// Seconds from the command, and values.
    pub points: Vec<[f64; 2]>,
}

/// The lines that are drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ComparedLines {
    /// The lines, the oldest first.
    pub lines: Vec<ComparedLine>,
    /// Lines there are.
    pub all: usize,
}

/// Sessions side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    of: Vec<(SessionId, usize)>,
    focus: SessionId,
    several_joints: bool,
    /// A row for each joint of each trial, in their order.
    pub rows: Vec<RowKey>,
    /// The settings tried, in their order.
    pub settings: Vec<TrialSetting>,
    /// The joints that those tried that are judged.
    pub joints: Vec<Dof>,
    /// What settings come to, over all sessions or over one: see [`Self::differences`].
    pub scores: Vec<Score>,
    /// Why settings are not judged over all sessions; empty if they are.
    pub differences: Vec<SessionDifference>,
    /// The best of the scores by the criterion that was judged by last.
    pub best: Option<Score>,
}

/// Its state by which a change is seen: trials are added to a session and never change.
fn stand(trials: &TrialsState, shown: &[SessionId]) -> Vec<(SessionId, usize)> {
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
    /// Puts these sessions side by side. Where they may not be taken together, what settings come to is of `focus` alone.
    pub fn of(trials: &TrialsState, shown: &[SessionId], focus: SessionId) -> Self {
        let of = stand(trials, shown);
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
            focus,
            of,
        }
    }

    /// Judges what settings come to by this.
    pub fn judge(&mut self, criterion: Criterion) {
        self.best = best(&self.scores, criterion).cloned();
    }

    /// Whether this setting is the best.
    pub fn is_best(&self, setting: TrialSetting) -> bool {
        let best = self.best.as_ref();
        best.is_some_and(|best| best.setting == setting)
    }

    /// True while it would come out the same.
    pub fn stands(&self, trials: &TrialsState, shown: &[SessionId], focus: SessionId) -> bool {
        self.focus == focus && self.of == stand(trials, shown)
    }

    /// The sessions, the oldest first.
    pub fn sessions(&self) -> impl ExactSizeIterator<Item = SessionId> + DoubleEndedIterator {
        self.of.iter().map(|(id, _)| *id)
    }

    /// What stands in a row.
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

    /// What a row has a colour for.
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

    /// The lines of a quantity: spread evenly over all there are, and none with more points than the eye sees. Those of
    /// the trial that stands out are among them whatever their number, last and with all their points.
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
