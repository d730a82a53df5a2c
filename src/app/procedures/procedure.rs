//! What a card shows and what the user may decide on it. Plain values; asks nobody.

use crate::app::env::running::Running;
use crate::hand::Moment;
use crate::link::{LinkHandle, Wake};
use crate::params::danger::Danger;
use crate::params::place::{PlacePair, WhichPlace};
use crate::tasks::calibrate::{CalibrateReport, CalibrateStep, Checks, Offsets};
use crate::tasks::hand::{REACH_TIMEOUT, answers};
use crate::tasks::place::{PlaceChange, PlaceReport, PlaceStep};
use crate::tasks::reset::{ResetReport, ResetStep};
use crate::tasks::{Reach, TaskError};
use crate::transport::Endpoint;
use futures::future::BoxFuture;
use std::path::PathBuf;
use tokio::sync::{mpsc, oneshot};

/// What the user decides on a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::VariantNames, strum::IntoStaticStr)]
pub enum ProcedureAction {
    /// Do it.
    Begin,
    /// The hand is where it should be.
    Keep,
    /// Take it back.
    GoBack,
    /// Put it into flash.
    Save,
    /// Leave it out of flash.
    LeaveUnsaved,
    /// The card was read.
    Close,
}

/// Where a card stands.
#[derive(Debug, Clone, PartialEq)]
pub enum ProcedureStage<S, E> {
    /// The user is asked.
    Asking,
    /// It is under way, since then.
    Doing(S, Moment),
    Over(E),
}

impl<S, E> ProcedureStage<S, E> {
    /// True while something is done for it.
    pub const fn is_doing(&self) -> bool {
        matches!(self, Self::Doing(..))
    }

    /// Takes in what the task told; true once it is over. `told` is asked whether a step is shown.
    pub(crate) fn take_news(
        &mut self,
        run: &mut Option<Running<S, E>>,
        mut told: impl FnMut(&S, Moment) -> bool,
    ) -> bool
    where
        S: Clone + Send + 'static,
        E: Send + 'static,
    {
        let Some(running) = run else { return false };
        let (steps, end) = running.news();
        for (at, step) in steps {
            if told(&step, at) {
                *self = Self::Doing(step, at);
            }
        }
        let Some(end) = end else { return false };
        (*self, *run) = (Self::Over(end), None);
        true
    }

    /// The result, once it is there.
    pub const fn end(&self) -> Option<&E> {
        match self {
            Self::Over(end) => Some(end),
            Self::Asking | Self::Doing(..) => None,
        }
    }
}

/// One card.
#[derive(Debug)]
pub enum Procedure {
    /// A change of what the hand is found by.
    Place(PlaceProcedure),
    /// A return to the factory's parameters.
    Reset(ResetProcedure),
    /// A calibration of the force sensors.
    Calibrate(CalibrateProcedure),
}

/// A change of what the hand is found by.
#[derive(Debug)]
pub struct PlaceProcedure {
    pub change: PlaceChange,
    /// Where it stands.
    pub stage: ProcedureStage<PlaceStep, Result<PlaceReport, TaskError>>,
    pub backup: Option<PathBuf>,
    /// What a SAVE would make last besides: it writes all that the hand holds.
    pub dangers: Vec<Danger>,
    pub(crate) run: Option<Running<PlaceStep, Result<PlaceReport, TaskError>>>,
    pub(crate) keeps: Option<oneshot::Sender<bool>>,
    pub(crate) saves: Option<oneshot::Sender<bool>>,
}

/// A return to the factory's parameters.
#[derive(Debug)]
pub struct ResetProcedure {
    /// Where the hand is before and after.
    pub places: PlacePair,
    /// Where it stands.
    pub stage: ProcedureStage<ResetStep, Result<ResetReport, TaskError>>,
    pub(crate) run: Option<Running<ResetStep, Result<ResetReport, TaskError>>>,
}

/// A calibration of the force sensors.
#[derive(Debug)]
pub struct CalibrateProcedure {
    /// What must be so before.
    pub checks: Checks,
    /// The offsets before, once it began.
    pub before: Option<Offsets>,
    /// Where it stands.
    pub stage: ProcedureStage<CalibrateStep, CalibrateReport>,
    pub(crate) run: Option<Running<CalibrateStep, CalibrateReport>>,
}

/// The card of a hand, if one is open, and where its task wants the link.
#[derive(Debug, Default)]
pub struct Procedures {
    pub card: Option<Procedure>,
    pub(crate) requested: Option<mpsc::Receiver<GoRequest>>,
}

impl Procedure {
    /// A card closes where nothing is under way.
    pub const fn may_close(&self) -> bool {
        !match self {
            Self::Place(card) => card.stage.is_doing(),
            Self::Reset(card) => card.stage.is_doing(),
            Self::Calibrate(card) => card.stage.is_doing(),
        }
    }
}

impl PlaceProcedure {
    /// Where the hand is, as far as the card knows; `None` if nobody does.
    pub fn place(&self) -> Option<WhichPlace> {
        match &self.stage {
            ProcedureStage::Over(Ok(report)) => report.end.place(),
            ProcedureStage::Doing(PlaceStep::Keeping(at) | PlaceStep::Offering(at), _) => Some(*at),
            ProcedureStage::Asking | ProcedureStage::Doing(..) | ProcedureStage::Over(Err(_)) => {
                Some(WhichPlace::Old)
            }
        }
    }
}

/// Asks the program for the link at a place.
#[derive(Debug)]
pub(crate) struct GoRequest {
    pub(crate) place: Endpoint,
    pub(crate) opened: oneshot::Sender<LinkHandle>,
}

/// Asks the program to go there.
pub(crate) struct Asking {
    pub(crate) requests: mpsc::Sender<GoRequest>,
    pub(crate) wake: Wake,
}

impl Reach for Asking {
    type Link = LinkHandle;

    async fn reach(&mut self, place: &Endpoint) -> Option<LinkHandle> {
        let (opened, open) = oneshot::channel();
        let place = place.clone();
        self.requests.send(GoRequest { place, opened }).await.ok()?;
        (self.wake)();
        let hand = open.await.ok()?;
        answers(&hand, REACH_TIMEOUT).await.then_some(hand)
    }
}

/// What the user decides on the card; a card that is gone decides nothing.
pub(crate) fn decided(answer: oneshot::Receiver<bool>) -> BoxFuture<'static, bool> {
    Box::pin(async { answer.await.unwrap_or(false) })
}
