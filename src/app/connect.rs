//! Dialling of built-in hands and all other wires. Only this module knows which hands are built in.

use crate::link::Clock;
use crate::sim::body_params::file;
use crate::sim::serve::{SharedHand, rs485};
use crate::sim::{BodyParams, Object, Scenario, SimConfig, SimHand, object_file};
use crate::transport::{
    BoxedWire, Dial, Endpoint, PortFound, SystemDial, TransportError, WireFailure, pair,
};
use futures::future::BoxFuture;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// A built-in hand. Like a real one, it keeps its state between connections.
struct Built {
    seed: u64,
    scenario: Scenario,
    body: Option<String>,
    object: Option<String>,
    hand: SharedHand,
}

/// The existing built-in hands and their clock.
#[derive(Clone)]
struct BuiltHands {
    clock: Clock,
    all: Arc<Mutex<Vec<Built>>>,
}

/// Dials all wires: `sim:` connects in memory to a built-in hand per seed, scenario, body and object; all others go to the system.
pub struct SimDial {
    system: SystemDial,
    built: BuiltHands,
    /// Built-in hand at the end of every RS485 line, if set.
    at_lines: Option<Endpoint>,
}

impl SimDial {
    /// Creates the dialler without hands; each is created when it is first dialled.
    pub fn new(clock: Clock) -> Self {
        let all = Arc::default();
        Self {
            system: SystemDial,
            built: BuiltHands { clock, all },
            at_lines: None,
        }
    }

    /// Like [`SimDial::new`], with this built-in hand at the end of every RS485 line: for screenshots of line-specific
    /// features.
    pub fn at_lines(clock: Clock, hand: Endpoint) -> Self {
        Self {
            at_lines: Some(hand),
            ..Self::new(clock)
        }
    }
}

impl BuiltHands {
    /// Returns the hand of this seed, scenario, body and object, creating it if needed. A file is read only for a new hand, on a
    /// blocking thread.
    async fn hand(&self, spec: SimHandSpec) -> Result<SharedHand, TransportError> {
        let scenario: Scenario =
            spec.scenario
                .parse()
                .map_err(|error: crate::sim::UnknownScenario| {
                    failed(WireFailure::NoScenario(error.to_string()))
                })?;
        if let Some(hand) = self.known(&spec, scenario) {
            return Ok(hand);
        }
        let body = match spec.body.clone() {
            None => BodyParams::default(),
            Some(path) => read_body(path).await?,
        };
        let object = match spec.object.clone() {
            None => None,
            Some(text) => Some(read_object(text, scenario).await?),
        };
        if let Some(hand) = self.known(&spec, scenario) {
            return Ok(hand);
        }
        let config = SimConfig {
            seed: spec.seed,
            scenario,
            body,
            object,
            ..SimConfig::default()
        };
        let began = self.clock.instant(self.clock.now());
        let hand = SharedHand::new(SimHand::new(config), began);
        let mut all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        // Disconnected hands make room.
        all.retain(|built| built.hand.is_shared());
        all.push(Built {
            seed: spec.seed,
            scenario,
            body: spec.body,
            object: spec.object,
            hand: hand.clone(),
        });
        Ok(hand)
    }

    fn known(&self, spec: &SimHandSpec, scenario: Scenario) -> Option<SharedHand> {
        let all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |built: &&Built| {
            built.seed == spec.seed
                && built.scenario == scenario
                && built.body == spec.body
                && built.object == spec.object
        };
        all.iter().find(is_it).map(|built| built.hand.clone())
    }
}

/// Parameters of a built-in hand, as named by an endpoint.
struct SimHandSpec {
    seed: u64,
    scenario: String,
    body: Option<String>,
    object: Option<String>,
}

async fn read_body(path: String) -> Result<BodyParams, TransportError> {
    let read = tokio::task::spawn_blocking(move || file::read(Path::new(&path)));
    match read.await {
        Ok(Ok(body)) => Ok(body),
        Ok(Err(error)) => Err(failed(WireFailure::NoBody(error.to_string()))),
        Err(gone) => Err(failed(WireFailure::NoBody(gone.to_string()))),
    }
}

async fn read_object(text: String, scenario: Scenario) -> Result<Object, TransportError> {
    let read = tokio::task::spawn_blocking(move || object_file::in_scenario(&text, scenario));
    match read.await {
        Ok(Ok(object)) => Ok(object),
        Ok(Err(error)) => Err(failed(WireFailure::NoObject(error.to_string()))),
        Err(gone) => Err(failed(WireFailure::NoObject(gone.to_string()))),
    }
}

fn failed(failure: WireFailure) -> TransportError {
    TransportError::Io {
        place: "sim:".into(),
        failure,
    }
}

impl Dial for SimDial {
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let hand = match (&self.at_lines, endpoint) {
            (Some(hand), Endpoint::Rs485(_)) => hand,
            _ => endpoint,
        };
        let Endpoint::Sim {
            seed,
            scenario,
            body,
            object,
        } = hand
        else {
            return self.system.dial(endpoint);
        };
        let spec = SimHandSpec {
            seed: *seed,
            scenario: scenario.clone(),
            body: body.clone(),
            object: object.clone(),
        };
        let built = self.built.clone();
        Box::pin(async move {
            let hand = built.hand(spec).await?;
            let (ours, its) = pair();
            // The task ends when our end of the wire is dropped.
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

    async fn hand_of(dial: &SimDial, seed: u64) -> SharedHand {
        let spec = SimHandSpec {
            seed,
            scenario: "idle".into(),
            body: None,
            object: None,
        };
        dial.built.hand(spec).await.unwrap()
    }

    #[tokio::test(start_paused = true)]
    async fn the_same_hand_is_there_after_a_reconnect() {
        let dial = SimDial::new(Clock::start());
        let first = hand_of(&dial, 1).await;
        drop(dial.dial(&Endpoint::sim()).await.unwrap());
        first
            .with(|hand, now| hand.write(register::HAND_ID.address, &[9], now))
            .unwrap();
        assert_eq!(hand_of(&dial, 1).await.with(|hand, _| hand.id()), 9);
        assert_eq!(hand_of(&dial, 2).await.with(|hand, _| hand.id()), 1);
    }

    #[tokio::test(start_paused = true)]
    async fn two_built_in_hands_are_there_at_once() {
        let dial = SimDial::new(Clock::start());
        let first = hand_of(&dial, 1).await;
        first
            .with(|hand, now| hand.write(register::HAND_ID.address, &[9], now))
            .unwrap();
        let second = hand_of(&dial, 2).await;
        assert_eq!(second.with(|hand, _| hand.id()), 1);
        assert_eq!(hand_of(&dial, 1).await.with(|hand, _| hand.id()), 9);
        drop(first);
        let _third = hand_of(&dial, 3).await;
        let again = hand_of(&dial, 1).await;
        assert_eq!(again.with(|hand, _| hand.id()), 1, "nobody had the first");
    }

    #[tokio::test(start_paused = true)]
    async fn an_unknown_scenario_is_said_in_words() {
        let endpoint = Endpoint::Sim {
            seed: 1,
            scenario: "party".into(),
            body: None,
            object: None,
        };
        let error = SimDial::new(Clock::start())
            .dial(&endpoint)
            .await
            .err()
            .unwrap();
        assert!(error.to_string().contains("party"), "{error}");
    }

    #[tokio::test(start_paused = true)]
    async fn a_body_is_read_from_its_file_and_a_wrong_one_is_said_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("body.toml");
        let dial = SimDial::new(Clock::start());
        let endpoint = Endpoint::Sim {
            seed: 1,
            scenario: "free".into(),
            body: Some(path.display().to_string()),
            object: None,
        };
        std::fs::write(&path, "[joint.index]\nlatency_ms = 900\n").unwrap();
        let error = dial.dial(&endpoint).await.err().unwrap().to_string();
        assert!(error.contains("line 2, `latency_ms`"), "{error}");
        std::fs::write(&path, "[joint.index]\nlatency_ms = 90\n").unwrap();
        drop(dial.dial(&endpoint).await.unwrap());
        let built = dial.built.all.lock().unwrap();
        let latency = built[0]
            .hand
            .with(|hand, _| hand.body().joints[crate::hand::Dof::Index].latency_ms);
        assert_eq!(latency, 90.0);
    }

    #[tokio::test(start_paused = true)]
    async fn an_object_is_held_by_name_and_an_unknown_one_is_said_in_words() {
        let dial = SimDial::new(Clock::start());
        let hand = |object: &str| Endpoint::Sim {
            seed: 1,
            scenario: "free".into(),
            body: None,
            object: Some(object.into()),
        };
        let error = dial.dial(&hand("rock")).await.err().unwrap().to_string();
        assert!(error.contains("cup, egg, sponge"), "{error}");
        drop(dial.dial(&hand("egg")).await.unwrap());
        let built = dial.built.all.lock().unwrap();
        assert_eq!(built.len(), 1);
        assert_eq!(built[0].object.as_deref(), Some("egg"));
    }
}
