//! What a person asks about grasp trials, and the series that runs on the hand.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::notices::{NoticeKind, Notices};
use crate::app::running::Running;
use crate::app::settings::Settings;
use crate::app::trials::action::TrialAction;
use crate::app::trials::form::tags;
use crate::app::trials::run::SeriesRun;
use crate::app::trials::state::{SessionId, SessionOrigin, TrialsState};
use crate::hand::{Dof, PerDof};
use crate::link::quirks::book;
use crate::record::EventKind;
use crate::store::calendar::{day, since_1970};
use crate::tasks::series::{SeriesStart, SeriesStep, series};
use crate::trials::plan_settings::to_settings;
use crate::trials::series::SeriesView;
use crate::trials::session::SessionHead;
use crate::trials::{Abort, EarlyEnd, Stage, TrialPlan, estimate};
use tokio::sync::oneshot;

/// Why a series cannot begin, besides its plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartRefusal {
    /// A person arms first.
    NotArmed,
    /// A joint that would have to move is locked.
    Locked(Dof),
    /// One runs already.
    Runs,
}

impl TrialsState {
    /// Carries out what needs neither a file nor the hand.
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
            TrialAction::Forget(id) => self.ask_to_forget(id),
            TrialAction::ConfirmForget => {
                if let Some(id) = self.to_confirm.take() {
                    self.forget(id);
                }
            }
            TrialAction::CancelForget => self.to_confirm = None,
            TrialAction::Start | TrialAction::Open(_) | TrialAction::Save(..) => {}
        }
    }

    /// Wants a session in its files; one that runs is kept at its end.
    fn keep(&mut self, id: SessionId) {
        if self.running != Some(id) {
            self.to_keep.push_back(id);
        }
    }

    /// A series that was broken off with its link has ended there: no hand has it any more. What to tell of it.
    pub(crate) fn close_broken_off(
        &mut self,
        runs: impl Fn(SessionId) -> bool,
    ) -> Option<NoticeKind> {
        let session = self.running.filter(|session| !runs(*session))?;
        Some(self.close(session, Some(Abort::LinkLost)))
    }

    /// The series that ran into this session is over; what to tell of it.
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

impl HandState {
    /// Why a plan cannot begin now, if it makes sense at all.
    pub fn start_refusal(&self, plan: &TrialPlan) -> Option<StartRefusal> {
        if self.runs_series() {
            return Some(StartRefusal::Runs);
        }
        if !self.is_armed() || self.link.armed.is_none() {
            return Some(StartRefusal::NotArmed);
        }
        let locked = self.joints.map(|joint| joint.locked);
        plan.locked(&locked).map(StartRefusal::Locked)
    }

    /// Begins the series that is planned, in the arming of now. Without one nothing happens.
    pub(crate) fn start_series(&mut self, trials: &mut TrialsState, env: &Env) {
        let plan = trials.plan.clone();
        let is_refused = self.start_refusal(&plan).is_some() || plan.check().is_err();
        // One series at a time: any key stops it, and it has the view to itself.
        if is_refused || trials.running.is_some() {
            return;
        }
        self.take_over();
        let (Some(epoch), Some(open)) = (self.link.armed, &mut self.open) else {
            return;
        };
        let start = SeriesStart {
            plan: plan.clone(),
            epoch,
            lease: open.lend_lease(),
            seen: self.sample,
            clock: env.clock,
        };
        let link = open.link.clone();
        let (end, ended) = oneshot::channel();
        let ended = async move {
            match ended.await {
                Ok(why) => why,
                Err(_gone) => std::future::pending().await,
            }
        };
        let task = Running::start(env, |steps| async move {
            let tell = |step| {
                steps.tell(step);
                true
            };
            series(&link, start, ended, tell).await
        });
        self.steered = PerDof::default();
        self.commanded = true;
        let head = self.session_head(plan.clone());
        let session = trials.add(head, SessionOrigin::Unsaved, Vec::new());
        (trials.last, trials.running) = (Some(session), Some(session));
        let (count, whole) = estimate::series(&plan);
        self.series = Some(SeriesRun {
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
            since: self.now,
            zero: self.now,
            each: whole / u32::try_from(count.max(1)).unwrap_or(u32::MAX),
            end: Some(end),
            task: Some(task),
        });
    }

    fn session_head(&self, plan: TrialPlan) -> SessionHead {
        let now = since_1970();
        let quirks = |hand| book::sheet(hand, &self.link.quirks, &day(now));
        SessionHead {
            hand: self.name(),
            simulated: self.is_simulated(),
            quirks: self.endpoint.as_ref().map(quirks),
            ..SessionHead::begin(plan, now)
        }
    }

    /// Takes in what the series did.
    pub(crate) fn tick_series(&mut self, trials: &mut TrialsState, notices: &mut Notices) {
        let now = self.now;
        let Some(mut run) = self.series.take() else {
            return;
        };
        let Some(task) = &mut run.task else {
            self.series = Some(run);
            return;
        };
        let (steps, end) = task.news();
        for (at, step) in steps {
            match step {
                SeriesStep::View(view) => {
                    if view.number != run.view.number {
                        (run.since, run.zero) = (at, at);
                        let words = format!("{} of {}", view.number, view.total);
                        self.record_event(at, EventKind::Trial, words);
                    }
                    if view.stage == Stage::Closing {
                        run.zero = at;
                    }
                    run.view = view;
                }
                SeriesStep::Trial(trial) => trials.add_trial(run.session, *trial),
            }
        }
        let Some(end) = end else {
            self.series = Some(run);
            return;
        };
        let aborted = end.ok().and_then(|report| report.aborted);
        notices.push(now, trials.close(run.session, aborted));
        // The task disarmed the hand, or stopped it.
        if self.link.armed == Some(run.epoch) {
            self.disarm();
        }
    }
}
