//! The program that moves a hand of the window: at most one.

use crate::app::checkup::CheckupRun;
use crate::app::env::motion_task::MotionTask;
use crate::app::hand::hold::{HoldMotion, HoldNews};
use crate::app::hand::scale::ScaleMotion;
use crate::app::inputs::FollowRun;
use crate::app::trials::{SeriesPlan, SeriesRun};
use crate::checkup::CheckupPlan;
use crate::hand::Moment;
use crate::hand::grip::GripThresholds;
use crate::link::Owner;
use crate::motion::grasp::run::GraspInput;
use crate::motion::hold::HoldView;
use crate::motion::play::{PlayCommand, PlayProgress};
use crate::motion::program::{Ended, Progress};
use crate::motion::scale::ScaleInput;
use crate::poses::library::EntryId;
use crate::poses::player::{PlayEnd, PlayPhase, PlayView};
use crate::record::Abort;

/// A series that starts once the hand is armed for it.
#[derive(Debug, Clone, PartialEq)]
pub enum AskedSeries {
    /// Trials.
    Trials(Box<SeriesPlan>),
    /// A check-up.
    Checkup(CheckupPlan),
}

/// The program that moves the hand, or a sequence that moved it last. Dropping it aborts its task.
#[derive(Debug)]
pub enum MotionRun {
    /// A series that starts once the requested arming holds, and the time of the request.
    Arming(AskedSeries, Moment),
    /// A sequence, also one that has ended.
    Sequence(SequenceRun),
    /// Trials or a search.
    Trials(Box<SeriesRun>),
    /// A check-up.
    Checkup(CheckupRun),
    /// An external source.
    Follow(FollowRun),
    /// A hold between two forces, also one that has ended.
    Hold(Box<HoldMotion>),
    /// A calibration with a kitchen scale, also one that has ended.
    Scale(Box<ScaleMotion>),
}

/// The one place for a program that moves a hand.
#[derive(Debug, Default)]
pub struct RunningMotion(pub(crate) Option<MotionRun>);

impl RunningMotion {
    /// The sequence that runs, or ran last.
    pub const fn sequence(&self) -> Option<&SequenceRun> {
        match &self.0 {
            Some(MotionRun::Sequence(run)) => Some(run),
            _ => None,
        }
    }

    /// The current or last sequence, mutable.
    pub(crate) const fn sequence_mut(&mut self) -> Option<&mut SequenceRun> {
        match &mut self.0 {
            Some(MotionRun::Sequence(run)) => Some(run),
            _ => None,
        }
    }

    /// The running trials or search.
    pub const fn series(&self) -> Option<&SeriesRun> {
        match &self.0 {
            Some(MotionRun::Trials(run)) => Some(&**run),
            _ => None,
        }
    }

    /// The running check-up.
    pub const fn checkup_run(&self) -> Option<&CheckupRun> {
        match &self.0 {
            Some(MotionRun::Checkup(run)) => Some(run),
            _ => None,
        }
    }

    /// The external source that the hand follows.
    pub const fn following(&self) -> Option<&FollowRun> {
        match &self.0 {
            Some(MotionRun::Follow(run)) => Some(run),
            _ => None,
        }
    }

    /// The hold that runs, or ran last.
    pub const fn hold(&self) -> Option<&HoldMotion> {
        match &self.0 {
            Some(MotionRun::Hold(run)) => Some(run),
            _ => None,
        }
    }

    /// The current or last hold, mutable.
    pub(crate) const fn hold_mut(&mut self) -> Option<&mut HoldMotion> {
        match &mut self.0 {
            Some(MotionRun::Hold(run)) => Some(run),
            _ => None,
        }
    }

    /// The calibration with a scale that runs, or ran last.
    pub const fn scale(&self) -> Option<&ScaleMotion> {
        match &self.0 {
            Some(MotionRun::Scale(run)) => Some(run),
            _ => None,
        }
    }

    /// The current or last calibration with a scale, mutable.
    pub(crate) const fn scale_mut(&mut self) -> Option<&mut ScaleMotion> {
        match &mut self.0 {
            Some(MotionRun::Scale(run)) => Some(run),
            _ => None,
        }
    }

    /// True while a sequence, a hold or a calibration with a scale runs.
    pub fn plays(&self) -> bool {
        let plays = self.sequence().is_some_and(SequenceRun::is_running);
        plays || self.holds() || self.calibrates()
    }

    /// Marks that a sequence, a hold or a calibration with a scale has lost control of the hand.
    pub(crate) fn leave(&mut self) {
        match &mut self.0 {
            Some(MotionRun::Sequence(run)) => run.leave(),
            Some(MotionRun::Hold(run)) => run.leave(),
            Some(MotionRun::Scale(run)) => run.leave(),
            _ => {}
        }
    }

    /// True while a calibration with a scale runs.
    pub fn calibrates(&self) -> bool {
        self.scale().is_some_and(ScaleMotion::is_running)
    }

    /// True while a hold runs.
    pub fn holds(&self) -> bool {
        self.hold().is_some_and(HoldMotion::is_running)
    }

    /// True while a series waits for arming.
    pub const fn awaits_arming(&self) -> bool {
        matches!(self.0, Some(MotionRun::Arming(..)))
    }

    /// True while a series of trials or a check-up runs.
    pub const fn runs_series(&self) -> bool {
        matches!(self.0, Some(MotionRun::Trials(_) | MotionRun::Checkup(_)))
    }

    /// Drops a series that waits for arming.
    pub(crate) fn forget_arming(&mut self) {
        self.0.take_if(|run| matches!(run, MotionRun::Arming(..)));
    }

    /// Ends a series or a hold early, because the user stopped the hand.
    pub(crate) fn end_series(&mut self) {
        self.forget_arming();
        match &mut self.0 {
            Some(MotionRun::Trials(run)) => run.end(Abort::Person),
            Some(MotionRun::Checkup(run)) => run.end(Abort::Person),
            Some(MotionRun::Hold(run)) => run.input(GraspInput::Abort(Abort::Person)),
            Some(MotionRun::Scale(run)) => run.answer(ScaleInput::Abort(Abort::Person)),
            Some(MotionRun::Arming(..) | MotionRun::Sequence(_) | MotionRun::Follow(_)) | None => {}
        }
    }

    /// True while the hand follows this party.
    pub(crate) fn follows(&self, owner: Owner) -> bool {
        self.following().is_some_and(|run| run.owner == owner)
    }
}

/// The current or last sequence, reaction, or pose with a path of several legs.
#[derive(Debug)]
pub struct SequenceRun {
    pub entry: EntryId,
    /// Current progress.
    pub view: PlayView,
    /// The hold of the current step; `None` while there is none.
    pub hold: Option<HoldView>,
    pub(crate) task: MotionTask<PlayCommand, PlayProgress, Ended<PlayEnd>>,
    /// Thresholds of the grip estimate for each step; empty once the user moves the hand in another way.
    pub(crate) thresholds: Vec<Option<GripThresholds>>,
}

impl SequenceRun {
    /// True while it may send setpoints.
    pub const fn is_running(&self) -> bool {
        !matches!(self.view.phase, PlayPhase::Ended(_))
    }

    /// True while a hold of it runs.
    pub const fn holds(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Holding { .. })
    }

    /// True while it waits for the user.
    pub const fn is_paused(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Paused)
    }

    /// Thresholds of the grip estimate for the current step; the defaults after an early end.
    pub(crate) fn thresholds(&self) -> GripThresholds {
        let is_asked = match self.view.phase {
            PlayPhase::Ended(end) => end == Ok(PlayEnd::Finished),
            _ => true,
        };
        let own = self.thresholds.get(self.view.at).copied().flatten();
        own.filter(|_| is_asked).unwrap_or_default()
    }

    pub(crate) fn command(&self, command: PlayCommand) {
        self.task.input(command);
    }

    /// Marks that it has lost control of the hand.
    pub(crate) fn leave(&mut self) {
        self.thresholds.clear();
        if self.is_running() {
            self.task.leave();
            self.view.phase = PlayPhase::Ended(Err(Abort::TakenOver));
        }
    }

    /// Applies the progress of its task; none after it lost control of the hand.
    pub(crate) fn news(&mut self) -> HoldNews {
        let mut news = HoldNews::default();
        let (steps, end) = self.task.news();
        for (at, step) in steps {
            match step {
                Progress::View(view) => {
                    self.view = view.play;
                    if let Some(hold) = view.hold {
                        news.see(self.hold.as_ref(), &hold);
                    }
                    self.hold = view.hold;
                }
                Progress::Sent(setpoints) => news.sent.push(setpoints),
                Progress::Event(tightened) => news.tightened.push((at, tightened)),
            }
        }
        if let Some(end) = end {
            if self.is_running() {
                self.view.phase = PlayPhase::Ended(end);
            }
            self.hold = None;
        }
        news
    }
}
