//! Contents of a card and the user's decisions on it. Plain values; requests nothing.

use crate::app::env::running::Running;
use crate::hand::Moment;
use crate::link::{LinkHandle, Wake};
use crate::params::danger::Danger;
use crate::params::place::{PlacePair, WhichPlace};
use crate::tasks::calibrate::{CalibrateReport, Checks, Offsets};
use crate::tasks::hand::{REACH_TIMEOUT, answers};
use crate::tasks::place::{PlaceChange, PlaceReport};
use crate::tasks::reset::ResetReport;
use crate::tasks::{Question, Reach, TaskError, TaskStep};
use crate::transport::Endpoint;
use std::path::PathBuf;
use tokio::sync::{mpsc, oneshot};

/// User decisions on a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::VariantNames, strum::IntoStaticStr)]
pub enum ProcedureAction {
    /// Start the procedure.
    Begin,
    /// Close the card.
    Close,
}

/// Stage of a card.
#[derive(Debug, Clone, PartialEq)]
pub enum ProcedureStage<E> {
    /// Waiting for the user to start.
    Asking,
    /// In progress: the current step and its start.
    Doing(TaskStep, Moment),
    Over(E),
}

impl<E> ProcedureStage<E> {
    /// True while the procedure is running.
    pub const fn is_doing(&self) -> bool {
        matches!(self, Self::Doing(..))
    }

    /// Applies the steps of the task; returns true once it has ended. The callback returns true for steps to show.
    pub(crate) fn apply_news(
        &mut self,
        run: &mut Option<Running<TaskStep, E>>,
        mut is_shown: impl FnMut(&TaskStep, Moment) -> bool,
    ) -> bool
    where
        E: Send + 'static,
    {
        let Some(running) = run else { return false };
        let (steps, end) = running.news();
        for (at, step) in steps {
            if is_shown(&step, at) {
                *self = Self::Doing(step, at);
            }
        }
        let Some(end) = end else { return false };
        (*self, *run) = (Self::Over(end), None);
        true
    }

    /// The result, once available.
    pub const fn end(&self) -> Option<&E> {
        match self {
            Self::Over(end) => Some(end),
            Self::Asking | Self::Doing(..) => None,
        }
    }
}

/// An open card.
#[derive(Debug)]
pub enum Procedure {
    /// Change of the hand's address.
    Place(PlaceProcedure),
    /// Reset to factory parameters.
    Reset(ResetProcedure),
    /// Calibration of the force sensors.
    Calibrate(CalibrateProcedure),
}

/// Change of the hand's address.
#[derive(Debug)]
pub struct PlaceProcedure {
    pub change: PlaceChange,
    pub stage: ProcedureStage<Result<PlaceReport, TaskError>>,
    pub backup: Option<PathBuf>,
    /// Dangers of a SAVE, which also saves the hand's other parameters.
    pub dangers: Vec<Danger>,
    pub(crate) run: Option<Running<TaskStep, Result<PlaceReport, TaskError>>>,
}

/// Reset to factory parameters.
#[derive(Debug)]
pub struct ResetProcedure {
    /// Addresses of the hand before and after.
    pub places: PlacePair,
    pub stage: ProcedureStage<Result<ResetReport, TaskError>>,
    pub(crate) run: Option<Running<TaskStep, Result<ResetReport, TaskError>>>,
}

/// Calibration of the force sensors.
#[derive(Debug)]
pub struct CalibrateProcedure {
    /// Preconditions.
    pub checks: Checks,
    /// Offsets before the calibration; `None` until it has started.
    pub before: Option<Offsets>,
    pub stage: ProcedureStage<CalibrateReport>,
    pub(crate) run: Option<Running<TaskStep, CalibrateReport>>,
}

/// The open card of a hand, if any, and its task's requests for a link.
#[derive(Debug, Default)]
pub struct Procedures {
    pub card: Option<Procedure>,
    pub(crate) requested: Option<mpsc::Receiver<LinkRequest>>,
}

impl Procedure {
    /// True unless a procedure is running.
    pub const fn may_close(&self) -> bool {
        !match self {
            Self::Place(card) => card.stage.is_doing(),
            Self::Reset(card) => card.stage.is_doing(),
            Self::Calibrate(card) => card.stage.is_doing(),
        }
    }
}

impl PlaceProcedure {
    /// The open question of the task, and the time since which it is open.
    pub fn question(&self) -> Option<(&Question, Moment)> {
        self.run.as_ref()?.question()
    }

    /// Address at which the hand is, as far as the card knows; `None` if unknown.
    pub fn place(&self) -> Option<WhichPlace> {
        if let Some((Question::KeepPlace(at) | Question::SavePlace(at), _)) = self.question() {
            return Some(*at);
        }
        match &self.stage {
            ProcedureStage::Over(Ok(report)) => report.end.place(),
            ProcedureStage::Doing(TaskStep::Kept(at), _) => Some(*at),
            ProcedureStage::Asking | ProcedureStage::Doing(..) | ProcedureStage::Over(Err(_)) => {
                Some(WhichPlace::Old)
            }
        }
    }
}

/// Request to open a link at an address.
#[derive(Debug)]
pub(crate) struct LinkRequest {
    pub(crate) place: Endpoint,
    pub(crate) opened: oneshot::Sender<LinkHandle>,
}

/// Sends link requests to the program.
pub(crate) struct LinkRequester {
    pub(crate) requests: mpsc::Sender<LinkRequest>,
    pub(crate) wake: Wake,
}

impl Reach for LinkRequester {
    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        let (opened, open) = oneshot::channel();
        let place = place.clone();
        self.requests
            .send(LinkRequest { place, opened })
            .await
            .ok()?;
        (self.wake)();
        let hand = open.await.ok()?;
        answers(&hand, REACH_TIMEOUT).await.then_some(hand)
    }
}
