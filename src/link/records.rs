//! What is heard of a link: its records one after the other, and what may be watched without keeping it open.

use crate::link::stats::LinkStats;
use crate::link::status::LinkStatus;
use crate::link::tap::WireTap;
use crate::record::Record;
use tokio::sync::broadcast::error::{RecvError, TryRecvError};
use tokio::sync::{broadcast, watch};

/// What may be watched of a link. The wire closes with the last handle, whoever still watches.
#[derive(Debug)]
pub struct LinkObserver {
    /// Everything that happens from the moment on at which it was made.
    pub records: Records,
    /// The recorded traffic.
    pub tap: WireTap,
    /// Where the link stands.
    pub status: watch::Receiver<LinkStatus>,
    /// Its statistics.
    pub stats: watch::Receiver<LinkStats>,
}

/// What happens at a hand, one record after the other. A reader that is too slow loses the oldest, and they are counted.
#[derive(Debug)]
pub struct Records {
    records: broadcast::Receiver<Record>,
    lost: u64,
}

impl Records {
    pub(crate) const fn of(records: broadcast::Receiver<Record>) -> Self {
        Self { records, lost: 0 }
    }

    /// The next record, if one waits.
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

    /// Records that this reader was too slow for.
    pub const fn lost(&self) -> u64 {
        self.lost
    }
}
