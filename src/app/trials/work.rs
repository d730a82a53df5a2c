//! Handling of trial requests, and the series that runs on the hand.

use crate::app::connection::Connection;
use crate::app::env::Ctx;
use crate::app::env::motion_task::MotionTask;
use crate::app::notices::NoticeKind;
use crate::app::settings::Settings;
use crate::app::trials::form::tags;
use crate::app::trials::state::{
    Search, SeriesPlan, SessionId, SessionOrigin, TrialAction, TrialsState,
};
use crate::hand::{ArmEpoch, Dof, HandSample, Moment};
use crate::link::quirks::book;
use crate::link::{Lease, LinkHandle};
use crate::motion::drive::Armed;
use crate::motion::program::Progress;
use crate::motion::series::{self, SeriesEvent, SeriesProgress};
use crate::record::Abort;
use crate::store::calendar::{day, since_1970};
use crate::trials::overshoot_file::{MeasuredClose, closes_of};
use crate::trials::plan_settings::to_settings;
use crate::trials::search::{Finding, SettingsSearch};
use crate::trials::series::SeriesView;
use crate::trials::session::SessionHead;
use crate::trials::{EarlyEnd, Stage, TrialPlan, estimate};
use std::time::Duration;

/// Reason why a series cannot start, apart from its plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartRefusal {
    /// The hand is not armed.
    NotArmed,
    /// A joint that would have to move is locked.
    Locked(Dof),
    /// A series is already running.
    Runs,
}

impl TrialsState {
    /// Handles actions that need neither a file nor the hand.
    pub(crate) fn act(&mut self, action: TrialAction, settings: &mut Settings) {
        match action {
            TrialAction::Plan(plan) => {
                settings.trial_plan = to_settings(&plan);
                self.plan = *plan;
            }
            TrialAction::Note(id, words) => {
                if let Some(session) = self.session_mut(id) {
                    session.head.note = words;
                    self.keep(id);
                }
            }
            TrialAction::Tags(id, words) => {
                if let Some(session) = self.session_mut(id) {
                    session.head.tags = tags(&words);
                    self.keep(id);
                }
            }
            TrialAction::Forget(id) => self.request_forget(id),
            TrialAction::ConfirmForget => {
                if let Some(id) = self.to_confirm.take() {
                    self.forget(id);
                }
            }
            TrialAction::CancelForget => self.to_confirm = None,
            TrialAction::Goal(goal) => self.goal = *goal,
            TrialAction::Start(_)
            | TrialAction::ArmAndStart(_)
            | TrialAction::ForgetOvershoot
            | TrialAction::ExportOvershoot
            | TrialAction::Open(_)
            | TrialAction::Save(..) => {}
        }
    }

    /// Queues a session for saving; a running one is saved when it ends.
    fn keep(&mut self, id: SessionId) {
        if self.running != Some(id) {
            self.to_keep.push_back(id);
        }
    }

    /// The search that belongs to this session.
    fn search_of(&mut self, id: SessionId) -> Option<&mut Search> {
        self.search.as_mut().filter(|search| search.session == id)
    }

    /// Closes a series that was aborted with its link and is no longer run by any hand. Returns the notice for the
    /// user.
    pub(crate) fn close_broken_off(
        &mut self,
        runs: impl Fn(SessionId) -> bool,
    ) -> Option<NoticeKind> {
        let session = self.running.filter(|session| !runs(*session))?;
        Some(self.close(session, Some(Abort::LinkLost)))
    }

    /// Closes the series of this session. Returns the notice for the user.
    fn close(&mut self, id: SessionId, aborted: Option<Abort>) -> NoticeKind {
        self.running = None;
        self.keep(id);
        let trials = self.session_mut(id).map_or(0, |session| {
            session.head.aborted = aborted.map(EarlyEnd::Here);
            session.trials.len()
        });
        NoticeKind::SeriesEnded { trials, aborted }
    }
}

/// A hand armed for a series.
pub(crate) struct SeriesHand<'a> {
    pub(crate) link: LinkHandle,
    pub(crate) lease: Lease,
    pub(crate) epoch: ArmEpoch,
    pub(crate) seen: HandSample,
    pub(crate) connection: &'a Connection,
}

/// Changes of a series since the last poll.
#[derive(Debug, Default)]
pub(crate) struct SeriesNews {
    /// Trials that started, with their descriptions.
    pub(crate) begun: Vec<(Moment, String)>,
    /// Measurements of the finished trials.
    pub(crate) measured: Vec<MeasuredClose>,
    /// Set once the series has ended.
    pub(crate) end: Option<NoticeKind>,
}

impl SeriesRun {
    /// Starts a series; `None` if the plan is invalid.
    pub(crate) fn begin(
        hand: SeriesHand<'_>,
        wanted: SeriesPlan,
        trials: &mut TrialsState,
        ctx: &Ctx<'_>,
    ) -> Option<Self> {
        let SeriesHand {
            link,
            lease,
            epoch,
            seen,
            connection,
        } = hand;
        let (plan, clock) = (wanted.trials(), ctx.env.clock);
        let series = wanted.begin(epoch, clock.now())?;
        let armed = Armed {
            epoch,
            lease,
            seen,
            clock,
        };
        let task = MotionTask::start(ctx.env, |steps, ends| async move {
            let tell = |step| {
                steps.send(step);
                true
            };
            let driven = series::trials(&link, armed, series, ends, tell).await;
            let search = driven.program.series.settings_search();
            SeriesEnd {
                aborted: driven.end.err(),
                finding: search.and_then(SettingsSearch::finding),
            }
        });
        let head = session_head(plan.clone(), connection);
        let session = trials.add(head, SessionOrigin::Unsaved, Vec::new());
        if let SeriesPlan::Search(goal) = wanted {
            trials.search = Some(Search {
                goal,
                session,
                progress: None,
                finding: None,
            });
        }
        (trials.last, trials.running) = (Some(session), Some(session));
        let (count, whole) = estimate::series(&plan);
        Some(Self {
            view: SeriesView {
                number: 0,
                total: count,
                setting: None,
                is_probing: false,
                stage: Stage::Resting,
            },
            epoch,
            session,
            plan,
            since: ctx.now,
            zero: ctx.now,
            each: whole / u32::try_from(count.max(1)).unwrap_or(u32::MAX),
            task,
        })
    }

    /// Applies the steps of the task and returns the changes.
    pub(crate) fn news(&mut self, trials: &mut TrialsState) -> SeriesNews {
        let mut news = SeriesNews::default();
        let (steps, end) = self.task.news();
        for (at, step) in steps {
            match step {
                Progress::Event(SeriesEvent::Search(progress)) => {
                    if let Some(search) = trials.search_of(self.session) {
                        search.progress = Some(*progress);
                    }
                }
                Progress::View(view) => {
                    if view.number != self.view.number {
                        (self.since, self.zero) = (at, at);
                        let closed = Dof::ALL
                            .into_iter()
                            .filter(|dof| self.plan.close[*dof].is_some());
                        let closed = closed.map(|dof| format!(", {}", dof.name()));
                        let closed: String = closed.collect();
                        let words = format!("{} of {}{closed}", view.number, view.total);
                        news.begun.push((at, words));
                    }
                    if view.stage == Stage::Closing {
                        self.zero = at;
                    }
                    self.view = view;
                }
                Progress::Event(SeriesEvent::Trial(trial)) => {
                    news.measured.extend(closes_of(&trial));
                    trials.add_trial(self.session, *trial);
                }
                Progress::Sent(_) => {}
            }
        }
        news.end = end.map(|end| {
            if let Some(search) = trials.search_of(self.session) {
                search.finding = end.finding;
            }
            trials.close(self.session, end.aborted)
        });
        news
    }
}

fn session_head(plan: TrialPlan, connection: &Connection) -> SessionHead {
    let now = since_1970();
    let quirks = |hand| book::sheet(hand, &connection.status.quirks, &day(now));
    SessionHead {
        hand: connection.name(),
        simulated: connection.is_simulated(),
        quirks: connection.endpoint.as_ref().map(quirks),
        ..SessionHead::begin(plan, now)
    }
}

/// Result of a series: the reason for an early end, and the finding of a search.
#[derive(Debug)]
pub(crate) struct SeriesEnd {
    pub(crate) aborted: Option<Abort>,
    pub(crate) finding: Option<Finding>,
}

/// A running series.
#[derive(Debug)]
pub struct SeriesRun {
    /// Current progress.
    pub view: SeriesView,
    pub epoch: ArmEpoch,
    /// Session that receives the trials.
    pub session: SessionId,
    pub plan: TrialPlan,
    /// Start of the current trial, or of the wait for it.
    pub since: Moment,
    /// Time origin of the current trial: the closing command, before that the start of the trial.
    pub zero: Moment,
    /// Approximate duration of a trial including the rest after it.
    pub(crate) each: Duration,
    task: MotionTask<Abort, SeriesProgress, SeriesEnd>,
}

impl SeriesRun {
    /// Approximate remaining time if nothing ends the series early.
    pub fn left(&self, now: Moment) -> Duration {
        let ahead = self.view.total.saturating_sub(self.view.number);
        let ahead = self.each * u32::try_from(ahead).unwrap_or(u32::MAX);
        ahead + self.each.saturating_sub(now.since(self.since))
    }

    /// Ends the series early. The caller stops the hand, and the task makes sure of it.
    pub(crate) fn end(&self, why: Abort) {
        self.task.input(why);
    }
}
