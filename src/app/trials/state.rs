//! The plan that is being written and the sessions that were run or opened. Sends nothing, reads no clock and no file.

use crate::app::notices::NoticeKind;
use crate::app::trials::lines::JointLines;
use crate::hand::{ArmEpoch, Moment};
use crate::trials::recording::TrialRecording;
use crate::trials::search::{Finding, SearchGoal, SearchProgress, SettingsSearch};
use crate::trials::session::SessionHead;
use crate::trials::{Criterion, Trial, TrialPlan, TrialSeries, TrialSummary};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

/// Rows that are held in memory for saving, over all trials: some hundred megabytes. The oldest trials drop theirs.
pub const ROWS_MAX: usize = 600_000;
/// Sessions in the list. The oldest that lies in files, or else the oldest, makes room.
pub const SESSIONS_MAX: usize = 24;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SessionId(pub u64);

/// Where a session lies.
#[derive(Debug, Clone, PartialEq)]
pub enum SessionOrigin {
    /// It was run here, and lies in no file.
    Unsaved,
    /// It was run here and saved in this folder.
    Saved(PathBuf),
    /// It was read from this folder.
    Folder(PathBuf),
}

impl SessionOrigin {
    /// Whether all of it lies in files.
    pub const fn is_in_files(&self) -> bool {
        !matches!(self, Self::Unsaved)
    }
}

/// One trial that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionTrial {
    /// What it was and came to.
    pub summary: TrialSummary,
    /// What is drawn of it, joint by joint.
    pub lines: Vec<JointLines>,
    /// What was read, to be saved; empty if it came from a file.
    pub recording: Arc<TrialRecording>,
}

impl SessionTrial {
    /// Of a trial that was run here.
    pub fn run(trial: Trial) -> Self {
        let read = Self::read(trial.summary, &trial.recording);
        Self {
            recording: Arc::new(trial.recording),
            ..read
        }
    }

    /// Of a trial whose samples lie in a file. Without any there is nothing to draw.
    pub fn read(summary: TrialSummary, recording: &TrialRecording) -> Self {
        let joints = summary.joints.iter();
        let joints = joints.filter(|_| !recording.rows().is_empty());
        Self {
            lines: joints.map(|own| JointLines::of(recording, own)).collect(),
            summary,
            recording: Arc::default(),
        }
    }

    fn rows(&self) -> usize {
        self.recording.rows().len()
    }

    fn drop_rows(&mut self) {
        let bare = self.recording.without_rows();
        self.summary.count(&bare);
        self.recording = Arc::new(bare);
    }
}

/// One series, whole or so far.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialSession {
    pub id: SessionId,
    /// The hand, the day, the plan, note and tags, and why it ended early.
    pub head: SessionHead,
    /// Where it lies.
    pub origin: SessionOrigin,
    /// What was tried, in its order.
    pub trials: Vec<SessionTrial>,
    /// Trials whose samples were dropped before they lay in files.
    pub lost: usize,
}

impl TrialSession {
    /// From the closing command of a trial to its end, in the program's time; `None` if it was not run here.
    pub fn stretch(&self, number: usize) -> Option<(Moment, Moment)> {
        let mut trials = self.trials.iter();
        let recording = &trials.find(|own| own.summary.number == number)?.recording;
        let end = recording.marks().last()?.at;
        Some((recording.zero(), end))
    }

    /// Drops the samples of its oldest trials, until so many rows less are held.
    fn drop_rows(&mut self, over: &mut usize) {
        let is_in_files = self.origin.is_in_files();
        for trial in self.trials.iter_mut().filter(|own| own.rows() > 0) {
            if *over == 0 {
                return;
            }
            *over = over.saturating_sub(trial.rows());
            trial.drop_rows();
            self.lost += usize::from(!is_in_files);
        }
    }
}

/// Which series is begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SeriesKind {
    /// A search for settings.
    #[default]
    Search,
    /// All settings of a grid.
    Grid,
}

/// What a series is to do.
#[derive(Debug, Clone, PartialEq)]
pub enum SeriesPlan {
    /// All settings of a grid.
    Grid(TrialPlan),
    /// Search for the fastest close under a limit.
    Search(SearchGoal),
}

impl SeriesPlan {
    pub const fn kind(&self) -> SeriesKind {
        match self {
            Self::Grid(_) => SeriesKind::Grid,
            Self::Search(_) => SeriesKind::Search,
        }
    }

    /// The plan of its trials; of a search that of the first.
    pub fn trials(&self) -> TrialPlan {
        match self {
            Self::Grid(plan) => plan.clone(),
            Self::Search(goal) => goal.plan(goal.first_setting()),
        }
    }

    /// The series, in an arming; `None` if it makes no sense.
    pub fn begin(&self, epoch: ArmEpoch, now: Moment) -> Option<TrialSeries> {
        match self {
            Self::Grid(plan) => TrialSeries::start(plan.clone(), epoch, now).ok(),
            Self::Search(goal) => {
                let search = SettingsSearch::new(goal.clone()).ok()?;
                Some(TrialSeries::search(search, epoch, now))
            }
        }
    }

    /// Whether it makes sense.
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Grid(plan) => plan.check().is_ok(),
            Self::Search(goal) => goal.check().is_ok(),
        }
    }
}

/// The search that runs or ran last.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    pub goal: SearchGoal,
    /// Where its trials are.
    pub session: SessionId,
    /// Where it stands; `None` before its first word.
    pub progress: Option<SearchProgress>,
    /// What it came to; `None` while it runs, and if it was ended early.
    pub finding: Option<Finding>,
}

/// Everything about trials that the window shows.
#[derive(Debug, Clone, Default)]
pub struct TrialsState {
    /// The plan that is being written.
    pub plan: TrialPlan,
    /// The goal that is being written.
    pub goal: SearchGoal,
    /// The search that runs or ran last.
    pub search: Option<Search>,
    /// The session whose series runs now.
    pub running: Option<SessionId>,
    /// What was tried here or opened, the oldest first.
    pub sessions: Vec<TrialSession>,
    /// The series that ended last, until the next begins.
    pub last: Option<SessionId>,
    /// The session that is about to be forgotten and lies in no file.
    pub to_confirm: Option<SessionId>,
    /// Why the last wish about files came to nothing; `None` if it did what it should.
    pub refused: Option<NoticeKind>,
    /// A session was to be read and was not: its path may be typed.
    pub asks_path: bool,
    /// The user asked for that, and it is not over.
    pub(crate) is_opening: bool,
    /// Sessions that are to be written without asking, the oldest wish first.
    pub(crate) to_keep: VecDeque<SessionId>,
    newest: u64,
}

impl TrialsState {
    /// The search that runs now.
    pub fn running_search(&self) -> Option<&Search> {
        let search = self.search.as_ref();
        search.filter(|search| self.running == Some(search.session))
    }

    /// What a series of this kind would do now.
    pub fn planned(&self, kind: SeriesKind) -> SeriesPlan {
        match kind {
            SeriesKind::Grid => SeriesPlan::Grid(self.plan.clone()),
            SeriesKind::Search => SeriesPlan::Search(self.goal.clone()),
        }
    }

    pub fn session(&self, id: SessionId) -> Option<&TrialSession> {
        self.sessions.iter().find(|session| session.id == id)
    }

    /// The same, to be changed.
    pub fn session_mut(&mut self, id: SessionId) -> Option<&mut TrialSession> {
        self.sessions.iter_mut().find(|session| session.id == id)
    }

    /// Adds a session.
    pub fn add(
        &mut self,
        head: SessionHead,
        origin: SessionOrigin,
        trials: Vec<SessionTrial>,
    ) -> SessionId {
        if self.sessions.len() >= SESSIONS_MAX {
            let in_files = |session: &TrialSession| session.origin.is_in_files();
            let at = self.sessions.iter().position(in_files).unwrap_or(0);
            let gone = self.sessions.remove(at);
            self.to_confirm = self.to_confirm.filter(|id| *id != gone.id);
        }
        self.newest += 1;
        let id = SessionId(self.newest);
        self.sessions.push(TrialSession {
            id,
            head,
            origin,
            trials,
            lost: 0,
        });
        id
    }

    /// Takes a session out of the list if it lies in files, else waits for a yes. The one that runs stays.
    pub fn ask_to_forget(&mut self, id: SessionId) {
        let runs = self.running == Some(id);
        match self.session(id).map(|session| session.origin.is_in_files()) {
            Some(true) => self.forget(id),
            Some(false) if !runs => self.to_confirm = Some(id),
            Some(false) | None => {}
        }
    }

    /// Takes a session out of the list. The one that runs stays.
    pub fn forget(&mut self, id: SessionId) {
        if self.running != Some(id) {
            self.sessions.retain(|session| session.id != id);
            self.to_confirm = self.to_confirm.filter(|asked| *asked != id);
        }
    }

    /// Adds a trial to a session, and holds no more rows than there is room for: what lies in files goes first, then the
    /// oldest.
    pub fn add_trial(&mut self, id: SessionId, trial: Trial) {
        if let Some(session) = self.session_mut(id) {
            session.trials.push(SessionTrial::run(trial));
        }
        let all = self.sessions.iter().flat_map(|session| &session.trials);
        let rows: usize = all.map(SessionTrial::rows).sum();
        let mut over = rows.saturating_sub(ROWS_MAX);
        for in_files in [true, false] {
            let sessions = self.sessions.iter_mut();
            for session in sessions.filter(|own| own.origin.is_in_files() == in_files) {
                session.drop_rows(&mut over);
            }
        }
    }
}

/// What the user asks for about trials.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum TrialAction {
    /// This is the plan now. Sends nothing.
    Plan(Box<TrialPlan>),
    /// Run a series, in the arming that is in force. Needs arming.
    Start(SeriesKind),
    /// Arm the hand, and run a series as soon as that holds.
    ArmAndStart(SeriesKind),
    /// This is the goal of the search now. Sends nothing.
    Goal(Box<SearchGoal>),
    /// Give a session this note.
    Note(SessionId, String),
    /// Give a session these tags, separated by commas.
    Tags(SessionId, String),
    /// Take a session out of the list; its files stay. What lies in no file is asked about first.
    Forget(SessionId),
    /// Yes, forget it without files too.
    ConfirmForget,
    /// No, it stays.
    CancelForget,
    /// Forget what trials measured of the hand that is shown.
    ForgetOvershoot,
    /// Save it as a table.
    ExportOvershoot,
    /// Read a saved session: one at a place that was typed, else one that is asked for.
    Open(Option<PathBuf>),
    /// Ask for a folder and save a session in a new one inside it; the report names the best by this.
    Save(SessionId, Option<Criterion>),
}
