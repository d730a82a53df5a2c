//! Scan for hands: its display, and the scan behind it. Never connects by itself.

use crate::app::env::Env;
use crate::hand::HandId;
use crate::link::scan::{
    FoundHand, Hosts, Local, ScanConfig, ScanEvent, ScanHandle, ScanPort, ScanProgress,
    ScanSummary, Speaks, start,
};
use crate::transport::Endpoint;
use std::sync::Arc;

/// Maximum number of listed hands: every ID on one bus, and some more.
const FOUND_MAX: usize = 512;
/// Maximum number of remarks: more than the user reads.
const REMARKS_MAX: usize = 32;
/// Maximum number of events processed per frame; the rest are queued, and the scan waits.
const EVENTS_PER_FRAME: usize = 64;
/// Number of IDs tried for [`IdRange::Few`].
const FEW: usize = 10;

/// Range of IDs tried on every bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IdRange {
    /// 1 to 10.
    #[default]
    Few,
    /// 1 to 254.
    All,
}

/// Target of a scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScanTarget {
    /// All serial ports and CAN interfaces of this computer.
    Ports(IdRange),
    /// This serial port, as an RS485 line or as a CAN adapter.
    Port(String, IdRange),
    /// This CAN interface.
    Interface(String, IdRange),
    /// Only these network addresses.
    Hosts(Hosts),
}

/// Stage of a scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ScanStage {
    /// No scan was started yet.
    #[default]
    Never,
    /// A scan is running.
    Running,
    /// The scan is complete.
    Done(ScanSummary),
    /// The user cancelled the scan.
    Cancelled,
}

/// State of the scan view.
#[derive(Debug, Default)]
pub struct ScanState {
    pub stage: ScanStage,
    /// Requested target.
    pub wish: Option<ScanTarget>,
    pub progress: ScanProgress,
    /// Number of buses and addresses to scan.
    pub places: usize,
    /// Hands found, in order of reply.
    pub found: Vec<FoundHand>,
    /// Other results: problems, hints, and ports in use.
    pub remarks: Vec<ScanEvent>,
    /// Number of hands and remarks dropped for lack of space.
    pub left_out: usize,
    /// Handle of the running scan.
    handle: Option<ScanHandle>,
}

impl ScanState {
    /// True while a scan is running.
    pub fn is_running(&self) -> bool {
        self.stage == ScanStage::Running
    }

    fn apply(&mut self, event: ScanEvent) {
        match event {
            ScanEvent::Begun { places, .. } => self.places = places,
            ScanEvent::Found(found) if self.found.len() < FOUND_MAX => self.found.push(found),
            ScanEvent::Found(_) => self.left_out += 1,
            ScanEvent::Done(summary) => self.stage = ScanStage::Done(summary),
            remark if self.remarks.len() < REMARKS_MAX => self.remarks.push(remark),
            _ => self.left_out += 1,
        }
    }

    /// Starts a scan, unless one is running. `held` lists the hands that are connected now.
    pub(crate) fn begin(&mut self, wish: ScanTarget, held: Vec<Endpoint>, env: &Env) {
        if self.handle.is_some() {
            return;
        }
        let (local, hosts, ids) = match wish.clone() {
            ScanTarget::Ports(ids) => (Local::Listed, Vec::new(), ids),
            ScanTarget::Port(port, ids) => {
                let wish = ScanPort {
                    port,
                    usb: None,
                    speaks: Speaks::Either,
                };
                (named(vec![wish], Vec::new()), Vec::new(), ids)
            }
            ScanTarget::Interface(can, ids) => (named(Vec::new(), vec![can]), Vec::new(), ids),
            ScanTarget::Hosts(hosts) => (named(Vec::new(), Vec::new()), vec![hosts], IdRange::Few),
        };
        let ids = match ids {
            IdRange::Few => FEW,
            IdRange::All => usize::MAX,
        };
        let config = ScanConfig {
            local,
            hosts,
            ids: HandId::all().take(ids).collect(),
            held,
            clock: env.clock,
            dial: Arc::clone(&env.dial),
            wake: Arc::clone(&env.wake),
        };
        *self = Self {
            stage: ScanStage::Running,
            wish: Some(wish),
            handle: Some(start(config, &env.runtime)),
            ..Self::default()
        };
    }

    /// Cancels the running scan; its results stay.
    pub(crate) fn cancel(&mut self) {
        if self.handle.take().is_some() {
            self.stage = ScanStage::Cancelled;
        }
    }

    /// Applies scan events.
    pub(crate) fn drain(&mut self) {
        let Some(mut handle) = self.handle.take() else {
            return;
        };
        self.progress = handle.progress();
        for event in std::iter::from_fn(|| handle.try_event()).take(EVENTS_PER_FRAME) {
            self.apply(event);
        }
        if self.is_running() {
            self.handle = Some(handle);
        }
    }
}

fn named(ports: Vec<ScanPort>, can: Vec<String>) -> Local {
    Local::Named { ports, can }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn found(id: u8) -> ScanEvent {
        ScanEvent::Found(FoundHand {
            endpoint: format!("rs485:/dev/x?id={id}").parse().unwrap(),
            hand_id: id,
            round_trip: Duration::from_millis(9),
            usb: None,
        })
    }

    #[test]
    fn what_has_no_room_is_counted() {
        let mut scan = ScanState::default();
        for _ in 0..=FOUND_MAX {
            scan.apply(found(1));
        }
        for _ in 0..=REMARKS_MAX {
            let place = "/dev/x".to_owned();
            scan.apply(ScanEvent::Held { place });
        }
        assert_eq!(
            (scan.found.len(), scan.remarks.len()),
            (FOUND_MAX, REMARKS_MAX)
        );
        assert_eq!(scan.left_out, 2);
    }
}
