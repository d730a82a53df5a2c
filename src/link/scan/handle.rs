//! The asking end of a scan: begins it, hears what it finds, ends it. Never waits for a wire.

use crate::hand::HandId;
use crate::link::clock::Clock;
use crate::link::config::Wake;
use crate::link::scan::board::{Board, ScanProgress};
use crate::link::scan::event::ScanEvent;
use crate::link::scan::hosts::Hosts;
use crate::link::scan::look::{ScanContext, look};
use crate::link::scan::plan::{
    HOSTS_AT_ONCE, LaneKind, PORTS_AT_ONCE, ScanPlan, ScanPort, ScanTargets, Speaks,
};
use crate::transport::{Dial, Endpoint, PortFound};
use futures::{StreamExt as _, stream};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::runtime::Handle;
use tokio::sync::mpsc;
use tokio_util::task::AbortOnDropHandle;

/// Events that may wait; a scan that is not listened to waits for its listener.
const EVENTS_MAX: usize = 256;

/// Which ports and interfaces of this computer are looked at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Local {
    /// All that the system lists. What looks like a CAN adapter is asked as one, all others as a serial line.
    Listed,
    /// Only the ones named here.
    Named {
        /// Serial ports.
        ports: Vec<ScanPort>,
        /// CAN interfaces.
        can: Vec<String>,
    },
}

/// What a scan is begun with.
#[derive(Clone)]
pub struct ScanConfig {
    /// Ports and interfaces.
    pub local: Local,
    /// Addresses in the network. None is ever added to them.
    pub hosts: Vec<Hosts>,
    /// Ids to try on every serial line and CAN bus.
    pub ids: Vec<HandId>,
    /// The hands that are connected now: the port of each is left alone.
    pub held: Vec<Endpoint>,
    /// The program's clock.
    pub clock: Clock,
    /// How wires are opened, and which there are.
    pub dial: Arc<dyn Dial>,
    /// Called when something new is there.
    pub wake: Wake,
}

/// One scan that runs. Dropping it ends the scan and closes every port.
#[derive(Debug)]
pub struct ScanHandle {
    events: mpsc::Receiver<ScanEvent>,
    board: Arc<Mutex<Board>>,
    _task: AbortOnDropHandle<()>,
}

/// Begins a scan. It reads HAND_ID and nothing else, and writes nothing.
pub fn start(config: ScanConfig, runtime: &Handle) -> ScanHandle {
    let (tell, events) = mpsc::channel(EVENTS_MAX);
    let board = Arc::new(Mutex::new(Board::default()));
    let room = ScanContext {
        dial: Arc::clone(&config.dial),
        clock: config.clock,
        events: tell,
        wake: Arc::clone(&config.wake),
        board: Arc::clone(&board),
        range_told: AtomicBool::new(false),
    };
    let task = AbortOnDropHandle::new(runtime.spawn(scan(config, Arc::new(room))));
    ScanHandle {
        events,
        board,
        _task: task,
    }
}

impl ScanHandle {
    /// The next event; `None` after the end.
    pub async fn event(&mut self) -> Option<ScanEvent> {
        self.events.recv().await
    }

    /// The next event, if one waits.
    pub fn try_event(&mut self) -> Option<ScanEvent> {
        self.events.try_recv().ok()
    }

    /// How far it is.
    pub fn progress(&self) -> ScanProgress {
        let board = self.board.lock().unwrap_or_else(PoisonError::into_inner);
        board.progress()
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
    *room.board() = Board::new(&plan);
    room.tell(ScanEvent::Begun {
        places: plan.places(),
        tries: plan.tries(),
        estimate: plan.estimate(),
    })
    .await;
    for place in &plan.held {
        let place = place.clone();
        room.tell(ScanEvent::Held { place }).await;
    }
    look_at_all(&room, plan).await;
    let mut summary = room.board().summary;
    summary.took = config.clock.now().since(begun);
    room.tell(ScanEvent::Done(summary)).await;
}

async fn look_at_all(room: &Arc<ScanContext>, plan: ScanPlan) {
    let lanes = plan.lanes.into_iter().enumerate();
    let (hosts, ports): (Vec<_>, Vec<_>) = lanes.partition(|(_, lane)| lane.kind == LaneKind::Host);
    let ports = stream::iter(ports).for_each_concurrent(PORTS_AT_ONCE, |(nth, lane)| {
        look(Arc::clone(room), nth, lane)
    });
    let hosts = stream::iter(hosts).for_each_concurrent(HOSTS_AT_ONCE, |(nth, lane)| {
        look(Arc::clone(room), nth, lane)
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

/// With what the system knows of the port.
fn known(mut wish: ScanPort, listed: &[PortFound]) -> ScanPort {
    let same = listed.iter().find(|port| port.path == wish.port);
    wish.usb = wish.usb.or_else(|| same.and_then(|port| port.usb.clone()));
    wish
}
