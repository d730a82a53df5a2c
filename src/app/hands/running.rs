//! The program that moves a hand of the window: at most one.

use crate::app::checkup::CheckupRun;
use crate::app::hand::SequenceRun;
use crate::app::inputs::FollowRun;
use crate::app::trials::{SeriesPlan, SeriesRun};
use crate::checkup::CheckupPlan;
use crate::hand::Moment;
use crate::link::Owner;
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

    /// Ends a series early, because the user stopped the hand.
    pub(crate) fn end_series(&mut self) {
        self.forget_arming();
        match &mut self.0 {
            Some(MotionRun::Trials(run)) => run.end(Abort::Person),
            Some(MotionRun::Checkup(run)) => run.end(Abort::Person),
            Some(MotionRun::Arming(..) | MotionRun::Sequence(_) | MotionRun::Follow(_)) | None => {}
        }
    }

    /// True while the hand follows this party.
    pub(crate) fn follows(&self, owner: Owner) -> bool {
        self.following().is_some_and(|run| run.owner == owner)
    }
}
