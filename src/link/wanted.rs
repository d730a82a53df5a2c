//! What the program wants of a session, and the session's ends of the channels between them.

use crate::hand::Setpoints;
use crate::link::image::RegisterImage;
use crate::link::poll::plan::{PollPriority, PollRates};
use crate::link::request::Request;
use crate::link::stats::LinkStats;
use crate::link::status::{ArmRequest, LinkStatus};
use crate::link::tap::WireTap;
use crate::record::Record;
use std::sync::Arc;
use tokio::sync::{broadcast, mpsc, watch};

/// What is wanted and the session has not taken yet. One slot, so that nothing queues up, and a stop empties it in the
/// same step.
#[derive(Debug, Default)]
pub(crate) struct PendingControl {
    pub(crate) stop: bool,
    pub(crate) disarm: bool,
    pub(crate) arm: Option<ArmRequest>,
    pub(crate) setpoints: Option<Setpoints>,
    pub(crate) rates: Option<PollRates>,
    pub(crate) closed: bool,
    /// Who may set targets: only the newest turn.
    pub(crate) turn: u64,
    /// What is read first while something moves.
    pub(crate) priority: PollPriority,
}

impl PendingControl {
    /// True if anything is wanted at all.
    pub(crate) const fn is_any(&self) -> bool {
        let moves = self.arm.is_some() || self.setpoints.is_some();
        self.stop || self.disarm || self.closed || moves || self.rates.is_some()
    }

    /// Gives out what is wanted; what outlasts it stays.
    pub(crate) fn take(&mut self) -> Self {
        let rest = Self {
            closed: self.closed,
            turn: self.turn,
            priority: self.priority,
            ..Self::default()
        };
        std::mem::replace(self, rest)
    }
}

/// The session's ends of what the handle holds.
pub(crate) struct Ends {
    pub(crate) wanted: Arc<watch::Sender<PendingControl>>,
    pub(crate) requests: mpsc::Receiver<Request>,
    pub(crate) records: broadcast::Sender<Record>,
    pub(crate) status: watch::Sender<LinkStatus>,
    pub(crate) stats: watch::Sender<LinkStats>,
    pub(crate) image: watch::Sender<RegisterImage>,
    pub(crate) tap: WireTap,
}
