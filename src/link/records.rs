//! Observation of a link: its records in order, and its state, without keeping it open.

use crate::link::stats::LinkStats;
use crate::link::status::LinkStatus;
use crate::link::tap::WireTap;
use crate::record::Record;
use tokio::sync::broadcast::error::{RecvError, TryRecvError};
use tokio::sync::{broadcast, watch};

/// Observes a link. The wire closes with the last handle, regardless of observers.
#[derive(Debug)]
pub struct LinkObserver {
    /// All records since the observer was created.
    pub records: Records,
    /// The recorded traffic.
    pub tap: WireTap,
    /// The link's status.
    pub status: watch::Receiver<LinkStatus>,
    /// Its statistics.
    pub stats: watch::Receiver<LinkStats>,
}

/// The records of a hand, in order. A reader that is too slow loses the oldest, which are counted.
#[derive(Debug)]
pub struct Records {
    records: broadcast::Receiver<Record>,
    lost: u64,
}

impl Records {
    pub(crate) const fn of(records: broadcast::Receiver<Record>) -> Self {
        Self { records, lost: 0 }
    }

    /// The next record, if one is available.
    pub fn try_next(&mut self) -> Option<Record> {
        loop {
            match self.records.try_recv() {
                Ok(record) => return Some(record),
                Err(TryRecvError::Lagged(lost)) => self.lost += lost,
                Err(TryRecvError::Empty | TryRecvError::Closed) => return None,
            }
        }
    }

    /// Waits for the next record. `None` once the session has ended.
    pub async fn next(&mut self) -> Option<Record> {
        loop {
            match self.records.recv().await {
                Ok(record) => return Some(record),
                Err(RecvError::Lagged(lost)) => self.lost += lost,
                Err(RecvError::Closed) => return None,
            }
        }
    }

    /// Number of records lost because this reader was too slow.
    pub const fn lost(&self) -> u64 {
        self.lost
    }
}
