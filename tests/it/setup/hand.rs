//! Simulated hands, and their servers behind a wire in memory.

use futures::FutureExt as _;
use handscope::hand::Dof;
use handscope::sim::serve::{can, modbus_rtu, modbus_tcp, rs485, slcan, usbcan};
use handscope::sim::{Object, Personality, SharedHand, SimConfig, SimHand, SimHands};
use handscope::transport::{Endpoint, Wire};
use tokio::task::JoinHandle;
use tokio::time::Instant;

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

/// Serves hands at the far end of a wire, in what the endpoint speaks.
pub(crate) fn serve(
    hands: impl Into<SimHands>,
    endpoint: &Endpoint,
    far: impl Wire,
) -> JoinHandle<()> {
    let hands: SimHands = hands.into();
    match endpoint {
        Endpoint::Rtu(_) => tokio::spawn(modbus_rtu::serve(hands, far)),
        Endpoint::Tcp { .. } => tokio::spawn(modbus_tcp::serve_client(hands, far)),
        Endpoint::Can { .. } => tokio::spawn(can::serve(hands, far).map(drop)),
        Endpoint::Slcan { .. } => tokio::spawn(slcan::serve(hands, far)),
        Endpoint::UsbCan { .. } => tokio::spawn(usbcan::serve(hands, far)),
        _ => tokio::spawn(rs485::serve(hands, far)),
    }
}
