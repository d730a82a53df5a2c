//! A hand behind a wire in memory on which every request is written down, a link to it, and a gateway in front of that.
//! Clients are those of tokio-modbus, which we did not write, or bytes.

use crate::setup::{hand, link};
use handscope::codec::mbap::MbapSplitter;
use handscope::codec::pdu::{self, ModbusRole, Pdu};
use handscope::hand::Span;
use handscope::link::{LinkHandle, PollRates, Records};
use handscope::record::LinkState;
use handscope::share::gateway::{Gateway, GatewayConfig, SILENCE, Writers};
use handscope::sim::SharedHand;
use handscope::sim::serve::modbus_tcp;
use handscope::transport::{Pipe, pair};
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::runtime::Handle;
use tokio::task::JoinHandle;
use tokio::time::sleep;
use tokio_modbus::client::{Context, tcp};
use tokio_modbus::prelude::Slave;

/// Far more than anything takes here.
pub(crate) const PATIENCE: Duration = Duration::from_secs(20);

/// What a wire carried, and whether there is one.
#[derive(Default)]
pub(crate) struct Wires {
    reads: Mutex<Vec<Span>>,
    writes: Mutex<Vec<u16>>,
    newest: Mutex<Option<JoinHandle<()>>>,
    is_cut: AtomicBool,
    is_silent: AtomicBool,
}

impl Wires {
    /// Reads so far that covered this byte.
    pub(crate) fn reads_of(&self, address: u16) -> usize {
        let reads = self.reads.lock().unwrap();
        let byte = Span::new(address, 1);
        reads.iter().filter(|span| span.covers(byte)).count()
    }

    /// All reads so far.
    pub(crate) fn reads(&self) -> usize {
        self.reads.lock().unwrap().len()
    }

    /// Addresses of all writes so far.
    pub(crate) fn writes(&self) -> Vec<u16> {
        self.writes.lock().unwrap().clone()
    }

    /// Breaks the wire; there is none until it is mended.
    pub(crate) fn cut(&self) {
        self.is_cut.store(true, Ordering::Relaxed);
        self.newest.lock().unwrap().take().unwrap().abort();
    }

    pub(crate) fn mend(&self) {
        self.is_cut.store(false, Ordering::Relaxed);
    }

    /// From now on nothing passes, or all does again; the wire is there.
    pub(crate) fn silent(&self, is_silent: bool) {
        self.is_silent.store(is_silent, Ordering::Relaxed);
    }

    fn note(&self, request: &[u8]) {
        match pdu::parse(ModbusRole::Client, request) {
            Pdu::Read { address, count } => {
                let span = Span::new(address, 2 * count);
                self.reads.lock().unwrap().push(span);
            }
            Pdu::WriteOne { address, .. } | Pdu::Write { address, .. } => {
                self.writes.lock().unwrap().push(address);
            }
            other => panic!("{other:?}"),
        }
    }

    /// Carries both ways, and writes down what is asked.
    async fn carry(self: Arc<Self>, mut ours: Pipe, mut hands: Pipe, takes: Duration) {
        let (mut asked, mut answered) = ([0; 512], [0; 512]);
        let mut splitter = MbapSplitter::default();
        loop {
            tokio::select! {
                read = ours.read(&mut asked) => {
                    let Ok(len @ 1..) = read else { return };
                    if self.is_silent.load(Ordering::Relaxed) { continue; }
                    splitter.push(&asked[..len]);
                    while let Some(adu) = splitter.next().unwrap() {
                        self.note(adu.pdu());
                    }
                    hands.write_all(&asked[..len]).await.unwrap();
                }
                read = hands.read(&mut answered) => {
                    let Ok(len @ 1..) = read else { return };
                    sleep(takes).await;
                    if ours.write_all(&answered[..len]).await.is_err() { return; }
                }
            }
        }
    }
}

/// A shared hand.
pub(crate) struct Place {
    pub(crate) hand: SharedHand,
    pub(crate) wires: Arc<Wires>,
    pub(crate) link: LinkHandle,
    pub(crate) gateway: Gateway,
    _records: Records,
}

/// A gateway at a free port that lets nobody write by itself.
pub(crate) fn config() -> GatewayConfig {
    GatewayConfig {
        address: ([127, 0, 0, 1], 0).into(),
        writers: Writers::Granted,
        silence: SILENCE,
    }
}

/// A live hand behind a gateway, read at these rates; each answer takes so long. Nobody may move it.
pub(crate) async fn share(rates: PollRates, takes: Duration) -> Place {
    share_as(config(), rates, takes).await
}

/// The same behind a gateway of this kind.
pub(crate) async fn share_as(gateway: GatewayConfig, rates: PollRates, takes: Duration) -> Place {
    let (hand, wires) = (hand::plain(), Arc::new(Wires::default()));
    let behind = (hand.clone(), Arc::clone(&wires));
    let dial = link::dial(move |endpoint| {
        let (hand, wires) = behind.clone();
        if wires.is_cut.load(Ordering::Relaxed) {
            return link::missing(endpoint.place());
        }
        let ((ours, middle), (its, far)) = (pair(), pair());
        tokio::spawn(modbus_tcp::serve_client(hand, far));
        let carried = Arc::clone(&wires).carry(middle, its, takes);
        *wires.newest.lock().unwrap() = Some(tokio::spawn(carried));
        link::opened(ours)
    });
    let mut config = link::config("tcp:hand", dial);
    config.rates = rates;
    let (link, records) = handscope::link::open(config, &Handle::current());
    let gateway = Gateway::open(link.clone(), gateway, &Handle::current()).unwrap();
    let place = Place {
        hand,
        wires,
        link,
        gateway,
        _records: records,
    };
    place.live().await;
    place
}

/// What is left of a place without its gateway.
pub(crate) struct Closed {
    pub(crate) link: LinkHandle,
    _records: Records,
}

impl Place {
    /// Closes the gateway.
    pub(crate) fn close(self) -> Closed {
        drop(self.gateway);
        Closed {
            link: self.link,
            _records: self._records,
        }
    }

    /// Waits until the hand is read.
    pub(crate) async fn live(&self) {
        until(|| self.link.status().state == LinkState::Monitoring).await;
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.gateway.address()
    }

    /// A client of another's making.
    pub(crate) async fn client(&self) -> Context {
        tcp::connect_slave(self.address(), Slave(255))
            .await
            .unwrap()
    }
}

/// Waits until something is so.
pub(crate) async fn until(wanted: impl Fn() -> bool) {
    let waited = tokio::time::timeout(PATIENCE, async {
        while !wanted() {
            sleep(Duration::from_millis(1)).await;
        }
    });
    waited.await.expect("it comes to be so");
}
