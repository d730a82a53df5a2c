//! The plan being edited, and the sessions that were run or opened, with the plot lines of their trials. Sends nothing, reads no
//! clock and no file.

use crate::app::notices::NoticeKind;
use crate::hand::{ArmEpoch, Dof, Moment};
use crate::trials::measure::curve::JointCurves;
use crate::trials::recording::TrialRecording;
use crate::trials::search::{Finding, SearchGoal, SearchProgress, SettingsSearch};
use crate::trials::session::SessionHead;
use crate::trials::{Criterion, JointMetrics, Trial, TrialPlan, TrialSeries, TrialSummary};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

/// Maximum number of rows in memory for saving, over all trials: some hundred megabytes. The oldest trials drop theirs
/// first.
pub const ROWS_MAX: usize = 600_000;
/// Maximum number of listed sessions. The oldest saved one is dropped, or else the oldest.
pub const SESSIONS_MAX: usize = 24;
/// Maximum number of points per plot line: two for each of more columns than a plot has pixels.
const POINTS_MAX: usize = 1000;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SessionId(pub u64);

/// Storage of a session.
#[derive(Debug, Clone, PartialEq)]
pub enum SessionOrigin {
    /// Run here and not saved.
    Unsaved,
    /// Run here and saved in this folder.
    Saved(PathBuf),
    /// Read from this folder.
    Folder(PathBuf),
}

impl SessionOrigin {
    /// True if the session is completely saved in files.
    pub const fn is_in_files(&self) -> bool {
        !matches!(self, Self::Unsaved)
    }
}

/// A finished trial.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionTrial {
    /// Setup and metrics of the trial.
    pub summary: TrialSummary,
    /// Plot lines, joint by joint.
    pub lines: Vec<JointLines>,
    /// Recorded samples, for saving; empty if read from a file.
    pub recording: Arc<TrialRecording>,
}

impl SessionTrial {
    /// Wraps a trial that was run here.
    pub fn run(trial: Trial) -> Self {
        let read = Self::read(trial.summary, &trial.recording);
        Self {
            recording: Arc::new(trial.recording),
            ..read
        }
    }

    /// Wraps a trial read from a file. Without samples there are no lines.
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

/// Quantity by which trials are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TrialQuantity {
    /// Force above the reading at rest, g.
    #[default]
    Force,
    /// ANGLE_ACT.
    Angle,
    /// Current, mA.
    Current,
    /// Normal force of the fingertip, N.
    Touch,
}

impl TrialQuantity {
    /// All quantities, in the order of the variants.
    pub const ALL: [Self; 4] = [Self::Force, Self::Angle, Self::Current, Self::Touch];
}

/// Plot lines of one joint, decimated to few points that retain every peak. Computed once, when the trial ends. Times are
/// seconds from the closing command.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLines {
    pub dof: Dof,
    /// Time of contact with the object; `None` if none was detected.
    pub contact_s: Option<f64>,
    /// Indexed by the order of [`TrialQuantity::ALL`].
    points: [Vec<[f64; 2]>; 4],
}

impl JointLines {
    /// Computes the lines from a recording and its metrics.
    pub fn of(recording: &TrialRecording, joint: &JointMetrics) -> Self {
        let curves = JointCurves::of(recording, joint.dof);
        let rest_g = joint.rest_force_g.unwrap_or(0.0);
        let force = curves.force.less(rest_g);
        let shown = [&force, &curves.angle, &curves.current, &curves.normal];
        Self {
            dof: joint.dof,
            contact_s: joint.time_to_contact_s.or(joint.time_to_touch_s),
            points: shown.map(|curve| curve.decimated(POINTS_MAX)),
        }
    }

    /// Points of (seconds, value) of a quantity; empty if it was not read.
    pub fn points(&self, quantity: TrialQuantity) -> &[[f64; 2]] {
        let points = self.points.get(quantity as usize);
        points.map_or(&[], Vec::as_slice)
    }
}

/// One series, complete or in progress.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialSession {
    pub id: SessionId,
    /// Hand, day, plan, note, tags, and the reason for an early end.
    pub head: SessionHead,
    pub origin: SessionOrigin,
    /// Trials, in order of execution.
    pub trials: Vec<SessionTrial>,
    /// Number of trials whose samples were dropped before they were saved.
    pub lost: usize,
}

impl TrialSession {
    /// Time from the closing command of a trial to its end, on the program's clock; `None` if it was not run here.
    pub fn stretch(&self, number: usize) -> Option<(Moment, Moment)> {
        let mut trials = self.trials.iter();
        let recording = &trials.find(|own| own.summary.number == number)?.recording;
        let end = recording.marks().last()?.at;
        Some((recording.zero(), end))
    }

    /// Drops the samples of the oldest trials until `over` rows are freed.
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

/// Kind of series.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SeriesKind {
    /// Search for settings.
    #[default]
    Search,
    /// All settings of a grid.
    Grid,
}

/// Complete definition of a series.
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

    /// Plan of the trials; for a search, that of the first trial.
    pub fn trials(&self) -> TrialPlan {
        match self {
            Self::Grid(plan) => plan.clone(),
            Self::Search(goal) => goal.plan(goal.first_setting()),
        }
    }

    /// Creates the series for an arming; `None` if the plan is invalid.
    pub fn begin(&self, epoch: ArmEpoch, now: Moment) -> Option<TrialSeries> {
        match self {
            Self::Grid(plan) => TrialSeries::start(plan.clone(), epoch, now).ok(),
            Self::Search(goal) => {
                let search = SettingsSearch::new(goal.clone()).ok()?;
                Some(TrialSeries::search(search, epoch, now))
            }
        }
    }

    /// True if the plan is valid.
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Grid(plan) => plan.check().is_ok(),
            Self::Search(goal) => goal.check().is_ok(),
        }
    }
}

/// The current or last search.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    pub goal: SearchGoal,
    /// Session that holds the trials.
    pub session: SessionId,
    /// Latest progress; `None` before the first report.
    pub progress: Option<SearchProgress>,
    /// Result; `None` while it runs, and if it ended early.
    pub finding: Option<Finding>,
}

/// State of the trials view.
#[derive(Debug, Clone, Default)]
pub struct TrialsState {
    /// Plan being edited.
    pub plan: TrialPlan,
    /// Search goal being edited.
    pub goal: SearchGoal,
    /// The current or last search.
    pub search: Option<Search>,
    /// Session of the running series.
    pub running: Option<SessionId>,
    /// Sessions run here or opened, oldest first.
    pub sessions: Vec<TrialSession>,
    /// Session of the last ended series, until the next one starts.
    pub last: Option<SessionId>,
    /// Unsaved session whose removal awaits confirmation.
    pub to_confirm: Option<SessionId>,
    /// Reason why the last file operation failed; `None` if it succeeded.
    pub refused: Option<NoticeKind>,
    /// True if opening a session failed: its path can be typed.
    pub asks_path: bool,
    /// Sessions to save without asking, in order of request.
    pub(crate) to_keep: VecDeque<SessionId>,
    newest: u64,
}

impl TrialsState {
    /// The running search.
    pub fn running_search(&self) -> Option<&Search> {
        let search = self.search.as_ref();
        search.filter(|search| self.running == Some(search.session))
    }

    /// Series that would be run now for this kind.
    pub fn planned(&self, kind: SeriesKind) -> SeriesPlan {
        match kind {
            SeriesKind::Grid => SeriesPlan::Grid(self.plan.clone()),
            SeriesKind::Search => SeriesPlan::Search(self.goal.clone()),
        }
    }

    pub fn session(&self, id: SessionId) -> Option<&TrialSession> {
        self.sessions.iter().find(|session| session.id == id)
    }

    pub fn session_mut(&mut self, id: SessionId) -> Option<&mut TrialSession> {
        self.sessions.iter_mut().find(|session| session.id == id)
    }

    /// Adds a session, dropping one if the list is full.
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

    /// Removes a saved session from the list; an unsaved one requires confirmation. The running session stays.
    pub fn request_forget(&mut self, id: SessionId) {
        let runs = self.running == Some(id);
        match self.session(id).map(|session| session.origin.is_in_files()) {
            Some(true) => self.forget(id),
            Some(false) if !runs => self.to_confirm = Some(id),
            Some(false) | None => {}
        }
    }

    /// Removes a session from the list, unless it is running.
    pub fn forget(&mut self, id: SessionId) {
        if self.running != Some(id) {
            self.sessions.retain(|session| session.id != id);
            self.to_confirm = self.to_confirm.filter(|asked| *asked != id);
        }
    }

    /// Adds a trial to a session, and drops rows over the limit: those of saved sessions first, then the oldest.
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

/// User requests concerning trials.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum TrialAction {
    /// Replace the plan. Sends nothing.
    Plan(Box<TrialPlan>),
    /// Start a series in the current arming. Needs arming.
    Start(SeriesKind),
    /// Arm the hand, and start a series once it is armed.
    ArmAndStart(SeriesKind),
    /// Replace the search goal. Sends nothing.
    Goal(Box<SearchGoal>),
    /// Set the note of a session.
    Note(SessionId, String),
    /// Set the tags of a session, separated by commas.
    Tags(SessionId, String),
    /// Remove a session from the list; its files stay. An unsaved one requires confirmation.
    Forget(SessionId),
    /// Confirm the removal of the unsaved session.
    ConfirmForget,
    /// Cancel the removal.
    CancelForget,
    /// Clear the measured overshoot of the current hand.
    ForgetOvershoot,
    /// Export the measured overshoot as a table.
    ExportOvershoot,
    /// Open a saved session at the typed path, else ask the user for one.
    Open(Option<PathBuf>),
    /// Ask for a folder and save a session in a new folder inside it; the report names the best setting by this
    /// criterion.
    Save(SessionId, Option<Criterion>),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trials::measure::curve::TimeSeries;

    #[test]
    fn a_thinned_line_is_short_and_keeps_its_peak() {
        let curve: TimeSeries = (0..90_000)
            .map(|n| (f64::from(n), if n == 45_678 { 2000.0 } else { 3.0 }))
            .collect();
        let points = curve.decimated(POINTS_MAX);
        assert!(points.len() <= POINTS_MAX);
        let column_s = 2.0 * 90_000.0 / 500.0;
        let is_peak = |[t, v]: &[f64; 2]| (t - 45_678.0).abs() < column_s && *v == 2000.0;
        assert!(points.iter().any(is_peak), "{points:?}");
        assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }
}
