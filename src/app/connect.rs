//! The built-in hand behind its wire, beside all other wires. The only place that knows that it is built in.

use crate::link::Clock;
use crate::sim::serve::{SharedHand, rs485};
use crate::sim::{Scenario, SimConfig, SimHand};
use crate::transport::{
    BoxedWire, Dial, Endpoint, PortFound, SystemDial, TransportError, WireFailure, pair,
};
use futures::future::BoxFuture;
use std::sync::{Mutex, PoisonError};

/// One built-in hand: it lives on between connections, as a real one does.
struct Built {
    seed: u64,
    scenario: Scenario,
    hand: SharedHand,
}

/// Dials everything: `sim:` to a built-in hand for each seed and scenario, over a wire in memory, anything else to the system.
pub struct SimDial {
    clock: Clock,
    system: SystemDial,
    built: Mutex<Vec<Built>>,
    /// The built-in hand that every RS485 line ends at, if they do.
    at_lines: Option<Endpoint>,
}

impl SimDial {
    /// No hand is built before it is dialled.
    pub const fn new(clock: Clock) -> Self {
        Self {
            clock,
            system: SystemDial,
            built: Mutex::new(Vec::new()),
            at_lines: None,
        }
    }

    /// As [`SimDial::new`], and every RS485 line ends at this built-in hand: for pictures of what only a line has.
    pub const fn at_lines(clock: Clock, hand: Endpoint) -> Self {
        Self {
            clock,
            system: SystemDial,
            built: Mutex::new(Vec::new()),
            at_lines: Some(hand),
        }
    }

    /// The hand of this seed and scenario: the one of last time, or a new one that begins now.
    fn hand(&self, seed: u64, scenario: &str) -> Result<SharedHand, TransportError> {
        let scenario: Scenario =
            scenario
                .parse()
                .map_err(|error: crate::sim::UnknownScenario| TransportError::Io {
                    place: "sim:".into(),
                    failure: WireFailure::NoScenario(error.to_string()),
                })?;
        let mut all = self.built.lock().unwrap_or_else(PoisonError::into_inner);
        let mut known = all.iter();
        if let Some(built) = known.find(|built| built.seed == seed && built.scenario == scenario) {
            return Ok(built.hand.clone());
        }
        // One that nobody is connected to makes room.
        all.retain(|built| built.hand.is_shared());
        let config = SimConfig {
            seed,
            scenario,
            ..SimConfig::default()
        };
        let hand = SharedHand::new(SimHand::new(config), self.clock.instant(self.clock.now()));
        all.push(Built {
            seed,
            scenario,
            hand: hand.clone(),
        });
        Ok(hand)
    }
}

impl Dial for SimDial {
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let hand = match (&self.at_lines, endpoint) {
            (Some(hand), Endpoint::Rs485(_)) => hand,
            _ => endpoint,
        };
        let Endpoint::Sim { seed, scenario } = hand else {
            return self.system.dial(endpoint);
        };
        let hand = self.hand(*seed, scenario);
        Box::pin(async move {
            let hand = hand?;
            let (ours, its) = pair();
            // Ends by itself when our end is dropped.
            tokio::spawn(rs485::serve(hand, its));
            let wire: BoxedWire = Box::new(ours);
            Ok(wire)
        })
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        self.system.ports()
    }

    fn interfaces(&self) -> BoxFuture<'static, Vec<String>> {
        self.system.interfaces()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register;

    #[tokio::test(start_paused = true)]
    async fn the_same_hand_is_there_after_a_reconnect() {
        let dial = SimDial::new(Clock::start());
        let first = dial.hand(1, "idle").unwrap();
        drop(dial.dial(&Endpoint::sim()).await.unwrap());
        first
            .with(|hand, now| hand.write(register::HAND_ID.address, &[9], now))
            .unwrap();
        assert_eq!(dial.hand(1, "idle").unwrap().with(|hand, _| hand.id()), 9);
        assert_eq!(dial.hand(2, "idle").unwrap().with(|hand, _| hand.id()), 1);
    }

    #[tokio::test(start_paused = true)]
    async fn two_built_in_hands_are_there_at_once() {
        let dial = SimDial::new(Clock::start());
        let first = dial.hand(1, "idle").unwrap();
        first
            .with(|hand, now| hand.write(register::HAND_ID.address, &[9], now))
            .unwrap();
        let second = dial.hand(2, "idle").unwrap();
        assert_eq!(second.with(|hand, _| hand.id()), 1);
        assert_eq!(dial.hand(1, "idle").unwrap().with(|hand, _| hand.id()), 9);
        drop(first);
        let _third = dial.hand(3, "idle").unwrap();
        let again = dial.hand(1, "idle").unwrap();
        assert_eq!(again.with(|hand, _| hand.id()), 1, "nobody had the first");
    }

    #[tokio::test(start_paused = true)]
    async fn an_unknown_scenario_is_said_in_words() {
        let endpoint = Endpoint::Sim {
            seed: 1,
            scenario: "party".into(),
        };
        let error = SimDial::new(Clock::start())
            .dial(&endpoint)
            .await
            .err()
            .unwrap();
        assert!(error.to_string().contains("party"), "{error}");
    }
}
