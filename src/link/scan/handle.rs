//! The caller's handle to a scan: starts it, receives its events, ends it. Never waits for a wire.

use crate::hand::HandId;
use crate::link::clock::Clock;
use crate::link::config::Wake;
use crate::link::scan::event::ScanEvent;
use crate::link::scan::hosts::Hosts;
use crate::link::scan::lane_scan::{ScanContext, scan_lane};
use crate::link::scan::plan::{
    HOSTS_AT_ONCE, LaneKind, PORTS_AT_ONCE, ScanPlan, ScanPort, ScanTargets, Speaks,
};
use crate::link::scan::tracker::{ScanProgress, ScanTracker};
use crate::transport::{Dial, Endpoint, PortFound};
use futures::{StreamExt as _, stream};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::runtime::Handle;
use tokio::sync::mpsc;
use tokio_util::task::AbortOnDropHandle;

/// Capacity of the event queue; a scan waits for its reader when it is full.
const EVENTS_MAX: usize = 256;

/// The local ports and interfaces to scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Local {
    /// All that the system lists. A port that looks like a CAN adapter is probed as one, all others as a serial line.
    Listed,
    /// Only the ones named here.
    Named {
        /// Serial ports.
        ports: Vec<ScanPort>,
        /// CAN interfaces.
        can: Vec<String>,
    },
}

/// Configuration of a scan.
#[derive(Clone)]
pub struct ScanConfig {
    /// Ports and interfaces.
    pub local: Local,
    /// Network addresses. None is ever added to them.
    pub hosts: Vec<Hosts>,
    /// Ids to try on every serial line and CAN bus.
    pub ids: Vec<HandId>,
    /// The connected hands: the port of each is skipped.
    pub held: Vec<Endpoint>,
    /// The program's clock.
    pub clock: Clock,
    /// Opens wires, and lists ports and interfaces.
    pub dial: Arc<dyn Dial>,
    /// Called when an event is available.
    pub wake: Wake,
}

/// One running scan. Dropping it ends the scan and closes every port.
#[derive(Debug)]
pub struct ScanHandle {
    events: mpsc::Receiver<ScanEvent>,
    tracker: Arc<Mutex<ScanTracker>>,
    _task: AbortOnDropHandle<()>,
}

/// Starts a scan. It reads HAND_ID and the registers that identify the series, and writes nothing.
pub fn start(config: ScanConfig, runtime: &Handle) -> ScanHandle {
    let (sender, events) = mpsc::channel(EVENTS_MAX);
    let tracker = Arc::new(Mutex::new(ScanTracker::default()));
    let room = ScanContext {
        dial: Arc::clone(&config.dial),
        clock: config.clock,
        events: sender,
        wake: Arc::clone(&config.wake),
        tracker: Arc::clone(&tracker),
        range_told: AtomicBool::new(false),
    };
    let task = AbortOnDropHandle::new(runtime.spawn(scan(config, Arc::new(room))));
    ScanHandle {
        events,
        tracker,
        _task: task,
    }
}

impl ScanHandle {
    /// The next event; `None` after the end.
    pub async fn event(&mut self) -> Option<ScanEvent> {
        self.events.recv().await
    }

    /// The next event, if one is available.
    pub fn try_event(&mut self) -> Option<ScanEvent> {
        self.events.try_recv().ok()
    }

    /// Present progress.
    pub fn progress(&self) -> ScanProgress {
        let tracker = self.tracker.lock().unwrap_or_else(PoisonError::into_inner);
        tracker.progress()
    }
}

async fn scan(config: ScanConfig, room: Arc<ScanContext>) {
    let begun = config.clock.now();
    let listed = config.dial.ports().await;
    let places = match config.local {
        Local::Listed => ScanTargets {
            ports: listed.into_iter().map(as_it_looks).collect(),
            can: config.dial.interfaces().await,
            hosts: config.hosts,
        },
        Local::Named { ports, can } => ScanTargets {
            ports: ports.into_iter().map(|wish| known(wish, &listed)).collect(),
            can,
            hosts: config.hosts,
        },
    };
    let plan = ScanPlan::new(&places, &config.ids, &config.held);
    *room.tracker() = ScanTracker::new(&plan);
    room.publish(ScanEvent::Begun {
        places: plan.places(),
        tries: plan.tries(),
        estimate: plan.estimate(),
    })
    .await;
    for place in &plan.held {
        let place = place.clone();
        room.publish(ScanEvent::Held { place }).await;
    }
    scan_lanes(&room, plan).await;
    let mut summary = room.tracker().summary;
    summary.took = config.clock.now().since(begun);
    room.publish(ScanEvent::Done(summary)).await;
}

async fn scan_lanes(room: &Arc<ScanContext>, plan: ScanPlan) {
    let lanes = plan.lanes.into_iter().enumerate();
    let (hosts, ports): (Vec<_>, Vec<_>) = lanes.partition(|(_, lane)| lane.kind == LaneKind::Host);
    let ports = stream::iter(ports).for_each_concurrent(PORTS_AT_ONCE, |(nth, lane)| {
        scan_lane(Arc::clone(room), nth, lane)
    });
    let hosts = stream::iter(hosts).for_each_concurrent(HOSTS_AT_ONCE, |(nth, lane)| {
        scan_lane(Arc::clone(room), nth, lane)
    });
    tokio::join!(ports, hosts);
}

fn as_it_looks(found: PortFound) -> ScanPort {
    let can = found.usb.as_ref().is_some_and(|usb| usb.looks_like_can());
    ScanPort {
        port: found.path,
        usb: found.usb,
        speaks: if can {
            Speaks::CanAdapter
        } else {
            Speaks::Hand
        },
    }
}

/// Adds what the system reports about the port.
fn known(mut wish: ScanPort, listed: &[PortFound]) -> ScanPort {
    let same = listed.iter().find(|port| port.path == wish.port);
    wish.usb = wish.usb.or_else(|| same.and_then(|port| port.usb.clone()));
    wish
}
