//! A hold between two forces with a hand of the window.

use crate::app::env::Env;
use crate::app::env::motion_task::MotionTask;
use crate::hand::grip::Tightened;
use crate::hand::hold_forces::HoldForces;
use crate::hand::newtons::ForceUnit;
use crate::hand::{Moment, Setpoints};
use crate::link::LinkHandle;
use crate::motion::drive::{Armed, drive};
use crate::motion::grasp::confirm::Agreement;
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::run::{
    ConfirmStep, Confirming, GraspInput, GraspRun, GraspStart, GraspView,
};
use crate::motion::grasp::saved::Grasp;
use crate::motion::grasp::seen::{GraspLabel, NoGrasp};
use crate::motion::hold::{HoldClose, HoldEnd, HoldPhase, HoldView};
use crate::motion::program::{Ended, Progress};
use crate::record::Abort;

/// A user action on a hold.
#[derive(Debug, Clone, PartialEq)]
pub enum HoldAction {
    /// Set its forces in a unit. Nothing is sent.
    Forces(ForceUnit, HoldForces),
    /// Choose the unit in which they are set. Nothing is sent.
    Unit(ForceUnit),
    /// Start it. Needs arming.
    Start(HoldClose),
    /// Hold as the grasp of this name. Needs arming.
    Repeat(String),
    /// Save the hold that ended as a grasp of the pose library, by the name of its pose or the next unused one.
    Save,
    /// Say that the object stands by itself: the hand opens, for the next close of a confirmation.
    PutDown,
    /// End it. The hand keeps its position, and so what it holds.
    End,
}

/// End of a watched hold.
pub type HoldEnded = Ended<Result<HoldEnd, GraspDoubt>>;

/// A hold that has ended, for saving it.
#[derive(Debug)]
struct HoldDone {
    program: GraspRun,
    at: Moment,
}

/// The current or last hold.
#[derive(Debug)]
pub struct HoldMotion {
    /// Current progress.
    pub view: HoldView,
    /// Progress of its confirmation, if it repeats a grasp of another hand.
    pub confirming: Option<Confirming>,
    /// Its end; `None` while it runs.
    pub end: Option<HoldEnded>,
    /// Unit of its forces.
    pub unit: ForceUnit,
    /// The grasp that it repeats.
    pub(crate) repeats: Option<Grasp>,
    task: MotionTask<GraspInput, Progress<GraspView, Tightened>, (HoldEnded, HoldDone)>,
    done: Option<HoldDone>,
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
    pub(crate) end: Option<HoldEnded>,
}

impl HoldNews {
    /// Notes a newer state of a hold.
    pub(crate) fn see(&mut self, before: Option<&HoldView>, now: &HoldView) {
        let is_short = |view: &HoldView| view.phase == HoldPhase::CannotHold;
        self.cannot_hold |= is_short(now) && !before.is_some_and(is_short);
    }
}

impl HoldMotion {
    /// Starts a hold.
    pub(crate) fn begin(
        link: LinkHandle,
        armed: Armed,
        (start, unit): (GraspStart, ForceUnit),
        repeats: Option<Grasp>,
        env: &Env,
    ) -> Self {
        let view = HoldView::first(start.hold.forces);
        let program = GraspRun::new(armed.epoch, start, env.clock.now());
        let clock = env.clock;
        let task = MotionTask::start(env, |steps, inputs| async move {
            let report = |progress| {
                steps.send(progress);
                true
            };
            let driven = drive(&link, armed, program, inputs, report).await;
            let (program, at) = (driven.program, clock.now());
            (driven.end, HoldDone { program, at })
        });
        Self {
            view,
            confirming: None,
            unit,
            repeats,
            done: None,
            end: None,
            task,
        }
    }

    /// True while it may send setpoints.
    pub const fn is_running(&self) -> bool {
        self.end.is_none()
    }

    /// The grasp of a hold that has ended; `None` while it runs.
    pub(crate) fn grasp(&self, about: GraspLabel) -> Option<Result<Grasp, NoGrasp>> {
        let done = self.done.as_ref()?;
        Some(done.program.grasp(about, done.at))
    }

    /// Reason why it is not saved as a grasp; `None` if it can be, or while it runs.
    pub fn not_saved(&self) -> Option<NoGrasp> {
        let done = self.done.as_ref()?;
        done.program.worked(done.at).err()
    }

    /// True once it has ended, also if it is not worth saving.
    pub const fn is_done(&self) -> bool {
        self.done.is_some()
    }

    /// The grasp that this hold confirmed, and how its closes agreed.
    pub(crate) fn confirmed(&self) -> Option<(Grasp, Agreement)> {
        let agreement = self.done.as_ref()?.program.agreement()?;
        Some((self.repeats.clone()?, agreement))
    }

    /// True while it waits for the user to say that the object stands.
    pub fn asks(&self) -> bool {
        let step = self.confirming.map(|own| own.step);
        self.is_running() && step == Some(ConfirmStep::Release)
    }

    /// Passes an input of the user to the program.
    pub(crate) fn input(&self, input: GraspInput) {
        self.task.input(input);
    }

    /// Marks that it has lost control of the hand.
    pub(crate) fn leave(&mut self) {
        if self.is_running() {
            self.task.leave();
            self.end = Some(Err(Abort::TakenOver));
        }
    }

    /// Applies the progress of its task; none after it lost control of the hand.
    pub(crate) fn news(&mut self) -> HoldNews {
        let mut news = HoldNews::default();
        let (steps, end) = self.task.news();
        for (at, step) in steps {
            match step {
                Progress::View(GraspView {
                    hold: view,
                    confirming,
                }) => {
                    news.see(Some(&self.view), &view);
                    (self.view, self.confirming) = (view, confirming);
                }
                Progress::Sent(setpoints) => news.sent.push(setpoints),
                Progress::Event(tightened) => news.tightened.push((at, tightened)),
            }
        }
        if let Some((end, done)) = end {
            (self.done, self.confirming) = (Some(done), None);
            if self.end.is_none() {
                (self.end, news.end) = (Some(end), Some(end));
            }
        }
        news
    }
}
