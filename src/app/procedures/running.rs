//! The task behind the card that is open, while it runs.

use crate::app::procedures::reach::GoRequest;
use crate::app::running::Running;
use crate::store::Job;
use crate::tasks::TaskError;
use crate::tasks::calibrate::{CalibrateReport, CalibrateStep};
use crate::tasks::place::{PlaceReport, PlaceStep};
use crate::tasks::reset::{ResetReport, ResetStep};
use crate::transport::endpoint::route::Route;
use tokio::sync::{mpsc, oneshot};

/// The task behind the card that is open.
#[derive(Debug)]
pub(crate) enum ProcedureTask {
    Place {
        run: Running<PlaceStep, Result<PlaceReport, TaskError>>,
        keeps: Option<oneshot::Sender<bool>>,
        saves: Option<oneshot::Sender<bool>>,
    },
    Reset(Running<ResetStep, Result<ResetReport, TaskError>>),
    Calibrate(Running<CalibrateStep, CalibrateReport>),
}

/// What belongs to the card that is open.
#[derive(Debug, Default)]
pub(crate) struct ProcedureWork {
    pub(crate) task: Option<ProcedureTask>,
    pub(crate) wishes: Option<mpsc::UnboundedReceiver<GoRequest>>,
    pub(crate) way: Option<Job<Option<Route>>>,
}
