//! One schedule: a wire with seeded faults, a hand, and somebody who arms, drags, asks and stops; then quiet.

use crate::link::faults::dial::FaultyDial;
use crate::link::faults::oracle::{Answer, Request, Seen, Witness};
use crate::link::faults::tap::{Lie, Log};
use crate::setup::body::{Adapter, Protocol, Quirks};
use crate::setup::faulty::{FaultOdds, FaultPlan, LineSpeed};
use crate::setup::hand;
use crate::setup::link::{self, Client};
use crate::setup::time::in_virtual_time;
use futures::future::BoxFuture;
use futures::stream::FuturesUnordered;
use futures::{FutureExt as _, StreamExt as _};
use handscope::hand::Setpoints;
use handscope::hand::{Angle, Dof, Fault, Force, Gesture, GestureRoute, HandCommand, Span, Target};
use handscope::link::handle::REQUESTS_MAX;
use handscope::link::{Clock, LinkConfig, PollRates, RequestError};
use handscope::record::{LinkState, Record};
use handscope::sim::{Personality, Scenario, SharedHand, SimConfig};
use std::sync::{Arc, Mutex};
use tokio::time::{Duration, Instant, sleep_until};

/// Virtual time with faults, and without, for the link to come back.
const FAULTY: Duration = Duration::from_millis(1500);
const QUIET: Duration = Duration::from_millis(3500);

/// What is made wrong on purpose, to see that the oracles notice.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sabotage {
    /// The device tells what was so long ago.
    pub(crate) lag: Duration,
    /// The log of the wire is wrong.
    pub(crate) lie: Lie,
    /// The wire never comes back.
    pub(crate) gone: bool,
}

/// Runs a whole schedule in virtual time.
pub(crate) fn run_seed(seed: u64, sabotage: Sabotage) -> Seen {
    in_virtual_time(async { Schedule::new(seed, sabotage).run().await })
}

/// Who else has a part in a schedule.
#[derive(Debug, Clone, Copy, Default)]
struct Actors {
    /// The hand's feedback freezes now and then.
    freezes: bool,
    /// Another program writes targets, past our wire.
    foreign: bool,
}

impl Actors {
    fn of(seed: u64) -> Self {
        Self {
            freezes: matches!(seed % 12, 0 | 1),
            foreign: matches!(seed % 12, 1 | 2),
        }
    }
}

struct Schedule {
    actors: Actors,
    /// How often another program will write targets yet, and their bytes.
    streamed: (u8, Vec<u8>),
    rng: fastrand::Rng,
    clock: Clock,
    hand: SharedHand,
    dial: Arc<FaultyDial>,
    link: Client,
    /// Requests under way, with their numbers.
    asked: FuturesUnordered<BoxFuture<'static, (u64, Answer)>>,
    numbers: u64,
    witness: Witness,
    sabotage: Sabotage,
}

fn odds(rng: &mut fastrand::Rng, protocol: Protocol) -> FaultOdds {
    let mut chance = |most: f64| if rng.bool() { rng.f64() * most } else { 0.0 };
    let (delay, hang_up) = (chance(0.1), chance(0.004));
    let (drop, corrupt) = (chance(0.15), chance(0.15));
    // A cut frame and its double make one frame of wrong bytes, which the 8-bit sum passes once in 256.
    let (truncate, duplicate) = if rng.bool() {
        (rng.f64() * 0.1, 0.0)
    } else {
        (0.0, rng.f64() * 0.2)
    };
    let odds = FaultOdds {
        drop,
        delay,
        corrupt,
        truncate,
        duplicate,
        hang_up,
    };
    match protocol {
        Protocol::Rs485 | Protocol::Rtu => odds,
        // TCP loses and changes nothing; it delays and breaks.
        Protocol::Tcp => FaultOdds {
            delay,
            hang_up,
            ..FaultOdds::default()
        },
        // CAN's own check finds a changed or cut frame, which is sent again. A read has up to forty frames.
        Protocol::Can => FaultOdds {
            drop: drop / 4.0,
            delay: delay / 4.0,
            corrupt: 0.0,
            truncate: 0.0,
            ..odds
        },
        // An adapter's text has no check: a changed digit is another value. The device spoils lines so that it shows.
        Protocol::Slcan => FaultOdds {
            drop: drop / 4.0,
            delay: delay / 4.0,
            corrupt: 0.0,
            ..odds
        },
    }
}

fn pace(rng: &mut fastrand::Rng, protocol: Protocol) -> Option<LineSpeed> {
    let bauds = match protocol {
        Protocol::Tcp => return None,
        // A record of 16 bytes takes 160 bits, as a frame of eight does with its head, stuffing and end.
        Protocol::Can => [None, Some(500_000), Some(1_000_000)],
        Protocol::Rs485 | Protocol::Rtu | Protocol::Slcan => [None, Some(115_200), Some(921_600)],
    };
    bauds[rng.usize(..3)].map(|baud| LineSpeed { baud })
}

fn endpoint(protocol: Protocol, pace: Option<LineSpeed>) -> String {
    match (protocol, pace) {
        (Protocol::Tcp, _) => "tcp:test".into(),
        (Protocol::Can, _) => "can:test".into(),
        (Protocol::Slcan, _) => "slcan:test".into(),
        (Protocol::Rs485, None) => "sim:".into(),
        (Protocol::Rtu, None) => "rtu:test".into(),
        (Protocol::Rs485, Some(pace)) => format!("rs485:test?baud={}", pace.baud),
        (Protocol::Rtu, Some(pace)) => format!("rtu:test?baud={}", pace.baud),
    }
}

fn quirks(rng: &mut fastrand::Rng, protocol: Protocol, lag: Duration) -> Quirks {
    let turnaround = Duration::from_micros(rng.u64(1_000..15_000));
    let one_in = match protocol {
        Protocol::Rs485 => 0,
        _ if rng.bool() => 0,
        Protocol::Rtu | Protocol::Tcp => rng.u32(4..40),
        Protocol::Can | Protocol::Slcan => rng.u32(16..400),
    };
    let mut odd = || rng.u8(..4) == 0;
    let adapter = Adapter {
        echoes: odd(),
        mute: odd(),
        stamps: odd(),
    };
    Quirks {
        turnaround,
        one_in: Arc::new(one_in.into()),
        adapter,
        lag,
        ..Quirks::default()
    }
}

impl Schedule {
    fn new(seed: u64, sabotage: Sabotage) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let clock = Clock::start();
        let protocol = Protocol::ALL[rng.usize(..Protocol::ALL.len())];
        if std::env::var_os("HANDSCOPE_SEED").is_some() {
            println!("seed {seed}: {protocol:?}");
        }
        let config = SimConfig {
            seed,
            id: 1,
            scenario: Scenario::Idle,
            personality: Personality::default(),
            ..SimConfig::default()
        };
        let hand = hand::shared(config);
        let actors = Actors::of(seed);
        let pace = pace(&mut rng, protocol);
        let plan = FaultPlan {
            seed,
            out: odds(&mut rng, protocol),
            back: odds(&mut rng, protocol),
            delay_max: Duration::from_millis(rng.u64(1..900)),
            // The framing's 8-bit sum lets one in 15 double flips pass; what it must catch is a single one.
            flips_max: 1,
            pace,
        };
        let log = Log::new(clock, sabotage.lie);
        let dial = Arc::new(FaultyDial {
            hand: hand.clone(),
            log: log.clone(),
            plan,
            quirks: Quirks {
                unstamped: actors.freezes,
                ..quirks(&mut rng, protocol, sabotage.lag)
            },
            protocol,
            state: Mutex::default(),
        });
        let rates = if rng.u8(..8) == 0 {
            PollRates::FULL
        } else {
            PollRates::default()
        };
        let link = link::open(LinkConfig {
            rates,
            clock,
            ..link::config(&endpoint(protocol, pace), dial.clone())
        });
        let mut witness = Witness::new(seed, protocol, log);
        witness.freezes = actors.freezes;
        witness.foreign = actors.foreign;
        witness.echoes = protocol == Protocol::Slcan && dial.quirks.adapter.echoes;
        Self {
            actors,
            streamed: (0, Vec::new()),
            rng,
            clock,
            hand,
            dial,
            link,
            asked: FuturesUnordered::new(),
            numbers: 0,
            witness,
            sabotage,
        }
    }

    async fn run(mut self) -> Seen {
        let end = Instant::now() + FAULTY;
        while Instant::now() < end {
            let pause = Duration::from_millis(self.rng.u64(1..120));
            self.drain_for(pause).await;
            self.act();
            self.others_act();
            self.witness.status(&self.link.status());
        }
        self.hand.with(|hand, now| hand.freeze_feedback(false, now));
        self.dial.quiet();
        self.witness.quiet(self.clock.now());
        if self.sabotage.gone {
            self.dial.cut(true);
        }
        self.hand
            .with(|hand, now| hand.write(1004, &[1], now))
            .unwrap();
        self.drain_for(QUIET).await;
        self.witness.finish(&self.link, self.clock.now());
        self.witness.seen.faults = self.dial.faults();
        self.witness.seen
    }

    /// Takes events for a while, each as it comes.
    async fn drain_for(&mut self, length: Duration) {
        let until = Instant::now() + length;
        loop {
            let mut is_armed = false;
            tokio::select! {
                biased;
                record = self.link.records.next() => {
                    let record = record.expect("the session lives as long as its handle");
                    let armed = LinkState::Armed;
                    is_armed = matches!(record, Record::State { state, .. } if state == armed);
                    self.witness.record(&record, self.clock.now());
                }
                Some((number, answer)) = self.asked.next() => {
                    self.witness.answered(number, &answer, self.clock.now());
                }
                () = sleep_until(until) => return,
            }
            let joints = self.hand.with(|hand, now| {
                hand.advance_to(now);
                hand.true_angles()
            });
            self.witness.reality(joints, self.clock.now());
            if is_armed {
                self.set();
            }
        }
    }

    /// Something that a person or the world does.
    fn act(&mut self) {
        match self.rng.u8(..40) {
            0..=9 => self.arm(),
            10..=19 => self.set(),
            20..=25 => self.stop(),
            26 | 27 => self.link.disarm(),
            28 | 29 => self.ask(Request::Command(HandCommand::ClearErrors)),
            30 | 31 => self.ask(Request::Command(HandCommand::Gesture(
                Gesture::MIN,
                GestureRoute::Register1008,
            ))),
            32 | 33 => {
                let len = self.rng.u16(1..60);
                self.ask(Request::Read(Span::new(1000, len)));
            }
            34 => self
                .hand
                .with(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall)),
            35 | 36 => self.dial.cut(self.rng.bool()),
            37 => self.flood(),
            _ => {
                self.arm();
                self.stop();
            }
        }
    }

    /// What the hand does by itself, and what another program does to it.
    fn others_act(&mut self) {
        if self.actors.freezes && self.rng.u8(..8) == 0 {
            let frozen = self.rng.u8(..4) != 0;
            self.witness.seen.freezes += u64::from(frozen);
            self.hand
                .with(|hand, now| hand.freeze_feedback(frozen, now));
        }
        if self.actors.foreign && self.rng.u8(..6) == 0 {
            // It says the same for a while, as a program that streams does.
            let targets: [i16; 6] = std::array::from_fn(|_| self.rng.i16(0..=1000));
            let bytes = targets.iter().flat_map(|value| value.to_le_bytes());
            self.streamed = (self.rng.u8(1..16), bytes.collect());
        }
        if let (left @ 1.., bytes) = &mut self.streamed {
            *left -= 1;
            self.witness.foreign_write(self.clock.now());
            self.hand
                .with(|hand, now| hand.write(1486, bytes, now).map(drop))
                .unwrap();
        }
    }

    fn arm(&mut self) {
        self.witness.seen.arm_asks += 1;
        self.link.arm(link::gentle());
    }

    fn set(&mut self) {
        let Some(epoch) = self.link.status().armed else {
            return;
        };
        let mut wish = Setpoints::none(epoch);
        for _ in 0..self.rng.u8(1..4) {
            let dof = Dof::ALL[self.rng.usize(..6)];
            wish.angle[dof] = Some(Target::Go(Angle::nearest(self.rng.i16(0..=1000))));
            wish.force[dof] = self.rng.bool().then_some(Force::RATED);
        }
        self.witness.wished(&wish.angle, self.clock.now());
        self.link.set(&wish);
    }

    fn stop(&mut self) {
        self.witness.stop_pressed(&self.link, self.clock.now());
        self.link.stop();
    }

    fn ask(&mut self, request: Request) {
        let mut answer = Box::pin(request.answer(self.link.clone(), self.link.lease()));
        match answer.as_mut().now_or_never() {
            None => {
                let number = self.numbers;
                self.numbers += 1;
                self.witness.asked(number, request, self.clock.now());
                let answer = answer.map(move |answer| (number, answer));
                self.asked.push(answer.boxed());
            }
            Some(Ok(_)) => panic!("a hand answers not before it is asked"),
            Some(Err(RequestError::Full { .. })) => self.witness.seen.full += 1,
            Some(Err(error)) => assert_eq!(error, RequestError::NotConnected),
        }
    }

    /// More requests at once than may wait.
    fn flood(&mut self) {
        if !self.link.status().state.is_live() {
            return;
        }
        let before = self.witness.seen.full;
        for n in 0..2 * REQUESTS_MAX as u16 {
            self.ask(Request::Read(Span::new(1000, 1 + n % 8)));
        }
        let refused = self.witness.seen.full - before;
        assert!(
            refused >= REQUESTS_MAX as u64,
            "{refused} of too many refused"
        );
    }
}
