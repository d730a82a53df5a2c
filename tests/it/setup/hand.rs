//! Simulated hands, and their servers behind a wire in memory.

use futures::FutureExt as _;
use futures::future::BoxFuture;
use handscope::hand::Dof;
use handscope::sim::serve::{can, modbus_rtu, modbus_tcp, rs485, slcan, usbcan};
use handscope::sim::{Object, Personality, SharedHand, SimConfig, SimHand, SimHands};
use handscope::transport::{Endpoint, LinePace, Wire, paced};
use tokio::task::JoinHandle;
use tokio::time::{Duration, Instant};

/// The default hand, whose time begins now.
pub(crate) fn plain() -> SharedHand {
    shared(SimConfig::default())
}

/// A hand whose time begins now.
pub(crate) fn shared(config: SimConfig) -> SharedHand {
    begin(SimHand::new(config))
}

/// Lets a hand's time begin now.
pub(crate) fn begin(hand: SimHand) -> SharedHand {
    SharedHand::new(hand, Instant::now())
}

/// Where a joint really is now.
pub(crate) fn true_angle(hand: &SharedHand, dof: Dof) -> f64 {
    hand.with(|hand, now| {
        hand.advance_to(now);
        hand.true_angles()[dof]
    })
}

/// A hand with nothing in its reach.
pub(crate) fn free(config: SimConfig) -> SimHand {
    let mut hand = SimHand::new(config);
    hand.set_object(&Object::none());
    hand
}

/// The default hand but for its id.
pub(crate) fn numbered(id: u8) -> SimConfig {
    SimConfig {
        id,
        ..SimConfig::default()
    }
}

/// The default hand but for how it reads the manual's gaps.
pub(crate) fn like(personality: Personality) -> SimConfig {
    SimConfig {
        personality,
        ..SimConfig::default()
    }
}

/// The speed of the hand's own serial line (manual 2.2). A wire in memory is read more often, which takes more computing.
const LINE: LinePace = LinePace {
    baud: 115_200,
    turnaround: Duration::from_millis(1),
};

/// Serves hands at the far end of a wire, in what the endpoint speaks.
pub(crate) fn serve(
    hands: impl Into<SimHands>,
    endpoint: &Endpoint,
    far: impl Wire,
) -> JoinHandle<()> {
    tokio::spawn(served(hands.into(), endpoint, far))
}

/// The same at the speed of the hand's own line.
pub(crate) fn serve_at_pace(
    hands: impl Into<SimHands>,
    endpoint: &Endpoint,
    far: impl Wire,
) -> JoinHandle<()> {
    let (hands, endpoint) = (hands.into(), endpoint.clone());
    let device = move |wire| served(hands, &endpoint, wire);
    tokio::spawn(paced(far, LINE, device))
}

fn served(hands: SimHands, endpoint: &Endpoint, far: impl Wire) -> BoxFuture<'static, ()> {
    match endpoint {
        Endpoint::Rtu(_) => modbus_rtu::serve(hands, far).boxed(),
        Endpoint::Tcp { .. } => modbus_tcp::serve_client(hands, far).boxed(),
        Endpoint::Can { .. } => can::serve(hands, far).map(drop).boxed(),
        Endpoint::Slcan { .. } => slcan::serve(hands, far).boxed(),
        Endpoint::UsbCan { .. } => usbcan::serve(hands, far).boxed(),
        _ => rs485::serve(hands, far).boxed(),
    }
}
