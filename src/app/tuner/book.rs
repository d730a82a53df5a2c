//! What was tried, and the series that runs now. Sends nothing, reads no clock and no file.

use crate::app::trial::estimate;
use crate::app::trial::recording::Recording;
use crate::app::trial::session::{Head, PlanRow};
use crate::app::trial::{Abort, Kind, Series, Setting, Trial, TrialMetrics, TrialPlan};
use crate::app::tuner::draft::Draft;
use crate::app::tuner::lines::Lines;
use crate::hand::Moment;
use crate::link::ArmEpoch;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Rows that are kept in memory for saving, over all trials: some hundred megabytes. The oldest trials let go of theirs.
pub const ROWS_MAX: usize = 600_000;
/// Sessions in the list. The oldest that is kept in files, or else the oldest, makes room.
pub const SESSIONS_MAX: usize = 24;

/// Which session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SessionId(pub u64);

/// Why something ended early.
#[derive(Debug, Clone, PartialEq)]
pub enum Ended {
    /// As it was seen here.
    Here(Abort),
    /// In the words of a file.
    Told(String),
}

/// Where a session comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// It was run in this window.
    Here {
        /// What was planned.
        plan: Box<TrialPlan>,
        /// Where it was saved last.
        saved: Option<PathBuf>,
    },
    /// It was read from files.
    Folder {
        /// Where they lie.
        path: PathBuf,
        /// What was planned.
        plan: Box<PlanRow>,
    },
}

impl Origin {
    /// Whether all of it lies in files.
    #[must_use]
    pub const fn is_kept(&self) -> bool {
        match self {
            Self::Here { saved, .. } => saved.is_some(),
            Self::Folder { .. } => true,
        }
    }
}

/// One trial that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// 1 the first.
    pub number: usize,
    /// How often this setting was tried, this one included; `None` = it looked for the contact.
    pub repeat: Option<usize>,
    /// Speed and threshold.
    pub setting: Setting,
    /// What was measured.
    pub metrics: TrialMetrics,
    /// Why it ended early.
    pub ended: Option<Ended>,
    /// What is drawn of it.
    pub lines: Lines,
    /// All of it, to be saved; `None` if it came from a file.
    pub whole: Option<Arc<Trial>>,
}

impl Tried {
    /// Of a trial that was run here.
    #[must_use]
    pub fn of(trial: Trial) -> Self {
        Self {
            number: trial.number,
            repeat: match trial.kind {
                Kind::Probe => None,
                Kind::Trial { repeat } => Some(repeat),
            },
            setting: trial.setting,
            metrics: trial.metrics.clone(),
            ended: trial.aborted.map(Ended::Here),
            lines: Lines::of(&trial.recording, &trial.metrics),
            whole: Some(Arc::new(trial)),
        }
    }

    fn rows(&self) -> usize {
        let whole = self.whole.as_ref();
        whole.map_or(0, |trial| trial.recording.rows().len())
    }

    fn let_go(&mut self) {
        if let Some(trial) = self.whole.take() {
            let mut bare = Trial {
                recording: Recording::default(),
                ..Trial::clone(&trial)
            };
            bare.recording = trial.recording.without_rows();
            self.whole = Some(Arc::new(bare));
        }
    }
}

/// One series, whole or so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Session {
    /// Which.
    pub id: SessionId,
    /// The hand, the day, note and tags.
    pub head: Head,
    /// Where it comes from.
    pub origin: Origin,
    /// What was tried, in its order.
    pub trials: Vec<Tried>,
    /// Why it ended early.
    pub ended: Option<Ended>,
    /// Trials whose samples were let go of before they lay in files.
    pub lost: usize,
}

impl Session {
    /// What was planned.
    #[must_use]
    pub fn plan(&self) -> PlanRow {
        match &self.origin {
            Origin::Here { plan, .. } => PlanRow::of(plan),
            Origin::Folder { plan, .. } => PlanRow::clone(plan),
        }
    }

    /// Lets go of the samples of its oldest trials, until so many rows less are held.
    fn let_go(&mut self, over: &mut usize) {
        let kept = self.origin.is_kept();
        for tried in self.trials.iter_mut().filter(|tried| tried.rows() > 0) {
            if *over == 0 {
                return;
            }
            *over = over.saturating_sub(tried.rows());
            tried.let_go();
            self.lost += usize::from(!kept);
        }
    }
}

/// A series on its way.
#[derive(Debug, Clone)]
pub struct Run {
    /// What runs.
    pub series: Series,
    /// Its arming.
    pub epoch: ArmEpoch,
    /// Where its trials go.
    pub session: SessionId,
    /// The plan.
    pub plan: TrialPlan,
    /// When the trial of now began, or the wait for it.
    pub since: Moment,
    /// Trials that had begun by then.
    pub begun: usize,
}

impl Run {
    /// About how long the rest of it takes, if nothing ends it.
    #[must_use]
    pub fn left(&self, now: Moment) -> Duration {
        let ahead = self.series.ahead();
        let ahead: Duration = ahead
            .map(|setting| estimate::trial(&self.plan, setting))
            .sum();
        let of_now = self.series.setting();
        let of_now = of_now.map_or(Duration::ZERO, |own| estimate::trial(&self.plan, own));
        ahead + of_now.saturating_sub(now.since(self.since))
    }
}

/// Everything about trials that the window shows.
#[derive(Debug, Clone, Default)]
pub struct TunerBook {
    /// The plan that is being written.
    pub draft: Draft,
    /// What runs now.
    pub run: Option<Run>,
    /// What was tried here or opened, the oldest first.
    pub sessions: Vec<Session>,
    /// The series that ended last, until the next begins.
    pub last: Option<SessionId>,
    /// The session that is about to be forgotten and lies in no file.
    pub question: Option<SessionId>,
    newest: u64,
}

impl TunerBook {
    /// True while a series may send something.
    #[must_use]
    pub const fn is_running(&self) -> bool {
        self.run.is_some()
    }

    /// One session.
    #[must_use]
    pub fn session(&self, id: SessionId) -> Option<&Session> {
        self.sessions.iter().find(|session| session.id == id)
    }

    /// The same, to be changed.
    pub fn session_mut(&mut self, id: SessionId) -> Option<&mut Session> {
        self.sessions.iter_mut().find(|session| session.id == id)
    }

    /// Adds a session.
    pub fn add(&mut self, head: Head, origin: Origin, trials: Vec<Tried>) -> SessionId {
        if self.sessions.len() >= SESSIONS_MAX {
            let kept = |session: &Session| session.origin.is_kept();
            let at = self.sessions.iter().position(kept).unwrap_or(0);
            let gone = self.sessions.remove(at);
            self.question = self.question.filter(|id| *id != gone.id);
        }
        self.newest += 1;
        let id = SessionId(self.newest);
        self.sessions.push(Session {
            id,
            head,
            origin,
            trials,
            ended: None,
            lost: 0,
        });
        id
    }

    /// Takes a session out of the list if it lies in files, else waits for a yes. The one that runs stays.
    pub fn ask_to_forget(&mut self, id: SessionId) {
        let runs = self.run.as_ref().is_some_and(|run| run.session == id);
        match self.session(id).map(|session| session.origin.is_kept()) {
            Some(true) => self.forget(id),
            Some(false) if !runs => self.question = Some(id),
            Some(false) | None => {}
        }
    }

    /// Takes a session out of the list. The one that runs stays.
    pub fn forget(&mut self, id: SessionId) {
        if self.run.as_ref().is_none_or(|run| run.session != id) {
            self.sessions.retain(|session| session.id != id);
            self.question = self.question.filter(|asked| *asked != id);
        }
    }

    /// Keeps a trial, and no more rows than there is room for: what lies in files goes first, then the oldest.
    pub fn keep(&mut self, id: SessionId, trial: Trial) {
        if let Some(session) = self.session_mut(id) {
            session.trials.push(Tried::of(trial));
        }
        let all = self.sessions.iter().flat_map(|session| &session.trials);
        let rows: usize = all.map(Tried::rows).sum();
        let mut over = rows.saturating_sub(ROWS_MAX);
        for kept in [true, false] {
            let sessions = self.sessions.iter_mut();
            for session in sessions.filter(|own| own.origin.is_kept() == kept) {
                session.let_go(&mut over);
            }
        }
    }
}
