//! Runs a series on the hand that is there: samples in, orders out, and what ends it. Decides nothing about trials.

use crate::app::calendar::day;
use crate::app::desk::Desk;
use crate::app::notices::NoticeKind;
use crate::app::quirk_sheet::QuirkSheet;
use crate::app::trial::session::Head;
use crate::app::trial::{self, Abort, LinkView, Order, Series};
use crate::app::tuner::book::{Ended, Origin, Run, SessionId};
use crate::app::tuner::draft::tags;
use crate::app::tuner::kept;
use crate::app::tuner::wish::TrialWish;
use crate::hand::{Dof, Groups, HandSample, Moment, PerDof};
use crate::link::PollRates;
use std::time::Duration;

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

impl crate::app::state::State {
    /// Why the plan that is written cannot begin now, if it makes sense at all.
    #[must_use]
    pub fn start_refusal(&self) -> Option<StartRefusal> {
        if self.tuner.is_running() {
            return Some(StartRefusal::Runs);
        }
        if !self.is_armed() || self.link.armed.is_none() {
            return Some(StartRefusal::NotArmed);
        }
        let locked = self.joints.map(|joint| joint.locked);
        self.tuner.draft.locked(&locked).map(StartRefusal::Locked)
    }
}

impl Desk {
    /// Carries out what needs no file. `since_1970` is the time of day.
    pub(crate) fn trial_wish(&mut self, wish: TrialWish, since_1970: Duration, now: Moment) {
        let tuner = &mut self.state.tuner;
        match wish {
            TrialWish::Draft(draft) => {
                tuner.draft = *draft;
                let kept = self.state.settings.trial_plan.as_ref();
                self.state.settings.trial_plan = kept::value(&tuner.draft, kept);
            }
            TrialWish::Start => self.start_series(since_1970, now),
            TrialWish::Note(id, words) => {
                if let Some(session) = tuner.session_mut(id) {
                    session.head.note = words;
                }
            }
            TrialWish::Tags(id, words) => {
                if let Some(session) = tuner.session_mut(id) {
                    session.head.tags = tags(&words);
                }
            }
            TrialWish::Forget(id) => tuner.ask_to_forget(id),
            TrialWish::Agree => {
                if let Some(id) = tuner.question.take() {
                    tuner.forget(id);
                }
            }
            TrialWish::Decline => tuner.question = None,
            TrialWish::Open | TrialWish::Save(..) => {}
        }
    }

    /// Begins the series that is planned, in the arming of now. Without one nothing happens.
    fn start_series(&mut self, since_1970: Duration, now: Moment) {
        if self.state.start_refusal().is_some() {
            return;
        }
        let Some(epoch) = self.state.link.armed else {
            return;
        };
        let plan = self.state.tuner.draft.plan();
        let Ok(series) = Series::start(plan.clone(), epoch, now) else {
            return;
        };
        self.take_over();
        self.following = PerDof::splat(true);
        self.commanded = true;
        let head = self.head(since_1970);
        let origin = Origin::Here {
            plan: Box::new(plan.clone()),
            saved: None,
        };
        let tuner = &mut self.state.tuner;
        let session = tuner.add(head, origin, Vec::new());
        tuner.last = Some(session);
        tuner.run = Some(Run {
            series,
            epoch,
            session,
            plan,
            since: now,
            begun: 0,
        });
        self.tick_trials(now);
    }

    fn head(&self, since_1970: Duration) -> Head {
        let state = &self.state;
        let quirks = |hand| QuirkSheet::new(hand, &state.link.quirks, &day(since_1970));
        Head {
            hand: state.hand_name(),
            simulated: state.is_simulated(),
            begun: since_1970,
            note: state.tuner.draft.note.clone(),
            tags: state.tuner.draft.tags.clone(),
            quirks: state.endpoint.as_ref().map(quirks),
        }
    }

    /// Keeps what was read, and looks at every reading for a reason to end: a peak lasts shorter than a frame.
    pub(crate) fn take_trials(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        if let Some(run) = &mut self.state.tuner.run {
            run.series.take(sample, fresh);
            self.tick_trials(now);
        }
    }

    /// Lets the series go on, or ends it.
    pub(crate) fn tick_trials(&mut self, now: Moment) {
        let Some(run) = &mut self.state.tuner.run else {
            return;
        };
        let view = LinkView::from(&self.state.link);
        let order = run.series.tick(&self.state.sample, view, now);
        let (begun, _) = run.series.progress();
        if begun != run.begun {
            (run.begun, run.since) = (begun, now);
        }
        match order {
            Some(Order::Set(setpoints)) => {
                if let Some(link) = &self.link {
                    link.set(&setpoints);
                }
            }
            Some(Order::Stop) => self.stop(now),
            None => {}
        }
        self.gather_trials(now);
    }

    /// Reads as fast as trials want while they run, and as a window wants at all other times.
    pub(crate) fn read_at_need(&mut self) {
        let rates = if self.state.tuner.is_running() {
            trial::RATES
        } else {
            PollRates::default()
        };
        if self.rates == rates {
            return;
        }
        self.rates = rates;
        if let Some(link) = &self.link {
            link.read_at(rates);
        }
    }

    /// Ends the series, if one runs. The stop itself is the caller's.
    pub(crate) fn end_trials(&mut self, why: Abort, now: Moment) {
        if let Some(run) = &mut self.state.tuner.run {
            run.series.end(why, now);
            self.gather_trials(now);
        }
    }

    /// Takes trials that are over; once the series is, the hand is not armed any more.
    fn gather_trials(&mut self, now: Moment) {
        let tuner = &mut self.state.tuner;
        let Some(mut run) = tuner.run.take() else {
            return;
        };
        while let Some(trial) = run.series.finished() {
            tuner.keep(run.session, trial);
        }
        if !run.series.is_over() {
            tuner.run = Some(run);
            return;
        }
        self.close_series(run.session, run.series.aborted(), now);
        // After an early end the stop disarms.
        let own = self.state.link.armed == Some(run.epoch);
        if own && run.series.aborted().is_none() {
            self.disarm(now);
        }
    }

    fn close_series(&mut self, id: SessionId, aborted: Option<Abort>, now: Moment) {
        let Some(session) = self.state.tuner.session_mut(id) else {
            return;
        };
        session.ended = aborted.map(Ended::Here);
        let trials = session.trials.len();
        let told = NoticeKind::SeriesEnded { trials, aborted };
        self.state.notices.push(now, told);
    }
}
