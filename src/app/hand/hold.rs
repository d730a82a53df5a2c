//! A hold between two forces with a hand of the window.

use crate::app::env::Env;
use crate::app::env::running::Running;
use crate::app::trials::work::ends;
use crate::hand::grip::Tightened;
use crate::hand::{Moment, Setpoints};
use crate::link::LinkHandle;
use crate::motion::drive::{Armed, drive};
use crate::motion::hold::{
    HoldClose, HoldEnd, HoldForces, HoldPhase, HoldRun, HoldStart, HoldView,
};
use crate::motion::program::{Ended, Progress};
use crate::record::Abort;
use tokio::sync::oneshot;

/// A user action on a hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HoldAction {
    /// Set its forces. Nothing is sent.
    Forces(HoldForces),
    /// Start it. Needs arming.
    Start(HoldClose),
    /// End it. The hand keeps its position, and so what it holds.
    End,
}

/// The current or last hold.
#[derive(Debug)]
pub struct HoldMotion {
    /// Current progress.
    pub view: HoldView,
    /// Its end; `None` while it runs.
    pub end: Option<Ended<HoldEnd>>,
    ender: Option<oneshot::Sender<Abort>>,
    task: Option<Running<Progress<HoldView, Tightened>, Ended<HoldEnd>>>,
}

/// News of a hold since the last poll.
#[derive(Debug, Default)]
pub(crate) struct HoldNews {
    pub(crate) sent: Vec<Setpoints>,
    /// Fingers that pressed harder.
    pub(crate) tightened: Vec<(Moment, Tightened)>,
    /// True if *at most* has ceased to suffice.
    pub(crate) cannot_hold: bool,
    /// Its end, once.
    pub(crate) end: Option<Ended<HoldEnd>>,
}

impl HoldMotion {
    /// Starts a hold.
    pub(crate) fn begin(link: LinkHandle, armed: Armed, start: HoldStart, env: &Env) -> Self {
        let view = HoldView::first(start.forces);
        let program = HoldRun::new(armed.epoch, start, env.clock.now());
        let (ender, ended) = oneshot::channel();
        let task = Running::start(env, |steps| async move {
            let report = |progress| {
                steps.send(progress);
                true
            };
            drive(&link, armed, program, ends(ended), report).await.end
        });
        Self {
            view,
            end: None,
            ender: Some(ender),
            task: Some(task),
        }
    }

    /// True while it may send setpoints.
    pub const fn is_running(&self) -> bool {
        self.end.is_none()
    }

    /// Ends it early.
    pub(crate) fn end(&mut self, why: Abort) {
        if let Some(ender) = self.ender.take() {
            // A closed channel means that it has ended.
            let _sent = ender.send(why);
        }
    }

    /// Marks that it has lost control of the hand.
    pub(crate) fn leave(&mut self) {
        if self.is_running() {
            self.end(Abort::TakenOver);
            self.end = Some(Err(Abort::TakenOver));
        }
    }

    /// Applies the progress of its task; none after it lost control of the hand.
    pub(crate) fn news(&mut self) -> HoldNews {
        let mut news = HoldNews::default();
        let Some(task) = &mut self.task else {
            return news;
        };
        let (steps, end) = task.news();
        for (at, step) in steps.into_iter().filter(|_| self.end.is_none()) {
            match step {
                Progress::View(view) => {
                    let short = HoldPhase::CannotHold;
                    news.cannot_hold |= view.phase == short && self.view.phase != short;
                    self.view = view;
                }
                Progress::Sent(setpoints) => news.sent.push(setpoints),
                Progress::Event(tightened) => news.tightened.push((at, tightened)),
            }
        }
        if let Some(end) = end {
            self.task = None;
            if self.end.is_none() {
                (self.end, news.end) = (Some(end), Some(end));
            }
        }
        news
    }
}
