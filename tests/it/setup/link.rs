//! A link to whatever a test puts behind a wire in memory, and what every test does with one.

use crate::setup::hand;
use futures::FutureExt as _;
use futures::future::{BoxFuture, ready};
use handscope::hand::{Angle, Force, PerDof, Setpoints, Speed, Target};
use handscope::link::{self, ArmRequest, Clock, Lease, LinkConfig, LinkHandle, LinkStatus};
use handscope::link::{Owner, PollRates, Records};
use handscope::record::{LinkState, Record};
use handscope::sim::{SharedHand, SimHands};
use handscope::transport::{BoxedWire, Dial, Endpoint, Pipe, TransportError, Wire, pair};
use std::cell::Cell;
use std::ops::Deref;
use std::sync::Arc;
use tokio::runtime::Handle;
use tokio::task::JoinHandle;
use tokio::time::{Duration, sleep, timeout};

/// Far more than anything takes that a test waits for without a limit of its own.
const PATIENCE: Duration = Duration::from_secs(20);

/// A request that has no end by then has none.
const ENDS_WITHIN: Duration = Duration::from_secs(10);

/// How a wire is dialled: at once, or not at all.
pub(crate) type Dialled = BoxFuture<'static, Result<BoxedWire, TransportError>>;

/// A dialled wire.
pub(crate) fn opened(wire: impl Wire) -> Dialled {
    let wire: BoxedWire = Box::new(wire);
    ready(Ok(wire)).boxed()
}

/// Nothing is at this place.
pub(crate) fn missing(place: String) -> Dialled {
    ready(Err(TransportError::Missing { place })).boxed()
}

/// Dials by a function.
struct By<F>(F);

impl<F: Fn(&Endpoint) -> Dialled + Send + Sync + 'static> Dial for By<F> {
    fn dial(&self, endpoint: &Endpoint) -> Dialled {
        (self.0)(endpoint)
    }
}

/// Opens what the function gives.
pub(crate) fn dial(open: impl Fn(&Endpoint) -> Dialled + Send + Sync + 'static) -> Arc<dyn Dial> {
    Arc::new(By(open))
}

/// Opens a new wire in memory each time, and gives its far end away.
pub(crate) fn behind(far: impl Fn(&Endpoint, Pipe) + Send + Sync + 'static) -> Arc<dyn Dial> {
    dial(move |endpoint| {
        let (ours, its) = pair();
        far(endpoint, its);
        opened(ours)
    })
}

/// Opens wires to simulated hands, which speak what the endpoint speaks.
pub(crate) fn to_hand(hands: impl Into<SimHands>) -> Arc<dyn Dial> {
    let hands: SimHands = hands.into();
    behind(move |endpoint, far| drop(hand::serve(hands.clone(), endpoint, far)))
}

/// The same at the speed of the hand's own line.
pub(crate) fn to_hand_at_pace(hands: impl Into<SimHands>) -> Arc<dyn Dial> {
    let hands: SimHands = hands.into();
    behind(move |endpoint, far| drop(hand::serve_at_pace(hands.clone(), endpoint, far)))
}

/// A link as the program opens it. Its time begins now.
pub(crate) fn config(endpoint: &str, dial: Arc<dyn Dial>) -> LinkConfig {
    LinkConfig {
        endpoint: endpoint.parse().unwrap(),
        rates: PollRates::default(),
        clock: Clock::start(),
        dial,
        wake: Arc::new(|| ()),
    }
}

/// An open link, and what the person who opened it has of it.
pub(crate) struct Client {
    link: LinkHandle,
    pub(crate) records: Records,
    lease: Cell<Lease>,
}

pub(crate) fn open(config: LinkConfig) -> Client {
    let (link, records) = link::open(config, &Handle::current());
    Client {
        lease: Cell::new(link.grant(Owner::Person)),
        link,
        records,
    }
}

impl Deref for Client {
    type Target = LinkHandle;

    fn deref(&self) -> &LinkHandle {
        &self.link
    }
}

impl Client {
    pub(crate) fn lease(&self) -> Lease {
        self.lease.get()
    }

    pub(crate) fn set(&self, setpoints: &Setpoints) {
        // One that ended is refused, and that is what is tried.
        let _set = self.link.set(self.lease(), setpoints);
    }

    /// A person grants the right to move the hand, and arms.
    pub(crate) fn arm(&self, request: ArmRequest) {
        if self.link.check(self.lease()).is_err() {
            self.lease.set(self.link.grant(Owner::Person));
        }
        self.link.arm(self.lease(), request).unwrap();
    }

    /// Asks while the test goes on.
    pub(crate) fn begin<F: Future<Output: Send> + Send + 'static>(
        &self,
        ask: impl FnOnce(LinkHandle) -> F,
    ) -> JoinHandle<F::Output> {
        tokio::spawn(ask(self.link.clone()))
    }
}

/// A link to this hand, which it sends to the fist.
pub(crate) async fn closing(hand: &SharedHand, wire: &str) -> Client {
    let mut link = connect(wire, to_hand(hand.clone()));
    live(&mut link).await;
    pass(&mut link, Duration::from_millis(200)).await;
    link.arm(gentle());
    let status = until(&mut link, PATIENCE, |status| status.armed.is_some()).await;
    let mut setpoints = Setpoints::none(status.armed.unwrap());
    setpoints.angle = PerDof::splat(Some(Target::Go(Angle::MIN)));
    link.set(&setpoints);
    link
}

/// Opens a link as the program does it.
pub(crate) fn connect(endpoint: &str, dial: Arc<dyn Dial>) -> Client {
    open(config(endpoint, dial))
}

/// Takes events until the link is as wanted; how it stands then.
pub(crate) async fn until(
    link: &mut Client,
    within: Duration,
    wanted: impl Fn(&LinkStatus) -> bool,
) -> LinkStatus {
    let seen = timeout(within, async {
        loop {
            let status = link.status();
            if wanted(&status) {
                return status;
            }
            while link.records.try_next().is_some() {}
            sleep(Duration::from_millis(1)).await;
        }
    })
    .await;
    seen.unwrap_or_else(|_| panic!("{:?} {:?}", link.status(), link.stats()))
}

/// Waits until the hand is read.
pub(crate) async fn live(link: &mut Client) {
    until(link, PATIENCE, |status| {
        status.state == LinkState::Monitoring
    })
    .await;
}

/// Time passes, and records are taken.
pub(crate) async fn pass(link: &mut Client, length: Duration) {
    let _over = timeout(length, async {
        while link.records.next().await.is_some() {}
    })
    .await;
}

/// Waits for a record that is as wanted.
pub(crate) async fn record(link: &mut Client, wanted: impl Fn(&Record) -> bool) {
    let found = timeout(PATIENCE, async {
        while !wanted(&link.records.next().await.unwrap()) {}
    });
    found.await.expect("the record comes");
}

/// What becomes of a request.
pub(crate) async fn ended<T>(request: impl Future<Output = T>) -> T {
    let ended = timeout(ENDS_WITHIN, request).await;
    ended.expect("every request comes to an end")
}

/// Asks for an arming with gentle limits.
pub(crate) fn gentle() -> ArmRequest {
    ArmRequest {
        speed: PerDof::splat(Speed::GENTLE),
        force: PerDof::splat(Force::GENTLE),
    }
}
