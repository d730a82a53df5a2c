//! Opens faulty wires to one hand, and counts what they did.

use crate::link::faults::can;
use crate::link::faults::tap::{Log, Tap};
use crate::setup::body::{Protocol, Quirks};
use crate::setup::device;
use crate::setup::faulty::{FaultPlan, FaultSwitch, faulty_pair};
use crate::setup::link;
use handscope::sim::SharedHand;
use handscope::transport::{Dial, Endpoint};
use std::sync::Mutex;
use std::sync::atomic::Ordering;

pub(crate) struct FaultyDial {
    pub(crate) hand: SharedHand,
    pub(crate) log: Log,
    pub(crate) plan: FaultPlan,
    pub(crate) quirks: Quirks,
    pub(crate) protocol: Protocol,
    pub(crate) state: Mutex<DialState>,
}

#[derive(Default)]
pub(crate) struct DialState {
    dials: u64,
    quiet: bool,
    away: bool,
    switch: Option<FaultSwitch>,
    cuts: u64,
    earlier_faults: u64,
}

impl FaultyDial {
    /// No faults from now on, on this wire and on all later ones.
    pub(crate) fn quiet(&self) {
        let mut state = self.state.lock().unwrap();
        state.quiet = true;
        self.quirks.one_in.store(0, Ordering::Relaxed);
        state.away = false;
        if let Some(switch) = &state.switch {
            switch.quiet();
        }
    }

    /// Cuts the wire; while it is away nothing can be dialled.
    pub(crate) fn cut(&self, away: bool) {
        let mut state = self.state.lock().unwrap();
        state.away = away;
        state.cuts += 1;
        if let Some(switch) = &state.switch {
            switch.hang_up();
        }
    }

    /// Faults made so far, by the wires, by the device and by cutting.
    pub(crate) fn faults(&self) -> u64 {
        let state = self.state.lock().unwrap();
        let wire = state.switch.as_ref().map_or(0, made);
        state.earlier_faults + wire + state.cuts + self.quirks.struck.load(Ordering::Relaxed)
    }
}

fn made(switch: &FaultSwitch) -> u64 {
    let counts = switch.counts();
    counts.dropped
        + counts.delayed
        + counts.corrupted
        + counts.truncated
        + counts.duplicated
        + counts.hang_ups
}

impl Dial for FaultyDial {
    fn dial(&self, _: &Endpoint) -> link::Dialled {
        let mut state = self.state.lock().unwrap();
        if state.away {
            return link::missing("test".into());
        }
        state.dials += 1;
        let seed = self.plan.seed.wrapping_mul(31).wrapping_add(state.dials);
        let (near, far, switch) = faulty_pair(FaultPlan { seed, ..self.plan });
        let (hand, quirks) = (self.hand.clone(), self.quirks.clone());
        if state.quiet {
            switch.quiet();
        }
        if let Some(earlier) = state.switch.replace(switch) {
            state.earlier_faults += made(&earlier);
        }
        match self.protocol {
            Protocol::Rs485 => tokio::spawn(device::rs485(hand, far, quirks)),
            Protocol::Rtu => tokio::spawn(device::modbus_rtu(hand, far, quirks, seed)),
            Protocol::Tcp => tokio::spawn(device::modbus_tcp(hand, far, quirks, seed)),
            Protocol::Can => tokio::spawn(can::records(hand, far, quirks, seed)),
            Protocol::Slcan => tokio::spawn(can::text(hand, far, quirks, seed)),
        };
        link::opened(Tap::new(near, self.log.clone(), self.protocol))
    }
}
