//! The link against seeded faults in virtual time: thousands of schedules, each with oracles on what was on the
//! wire and what was told to the window. `HANDSCOPE_SEED=n cargo test --test link_faults` replays one,
//! `HANDSCOPE_SCHEDULES=n` runs more.
#![allow(
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    clippy::cast_sign_loss,
    reason = "a test may"
)]

#[path = "faults/device.rs"]
mod device;
#[path = "faults/oracle.rs"]
mod oracle;
#[path = "faults/tap.rs"]
mod tap;

use device::{Protocol, Quirks};
use futures::FutureExt as _;
use futures::future::BoxFuture;
use handscope::hand::{
    Angle, Dof, Fault, Force, Gesture, GestureRoute, HandCommand, PerDof, Span, Speed, Target,
};
use handscope::link::{
    self, ArmRequest, Clock, LinkConfig, LinkEvent, LinkHandle, LinkState, PollRates, Request,
    Setpoints,
};
use handscope::sim::{Personality, Scenario, SharedHand, SimConfig, SimHand};
use handscope::transport::{
    BoxedWire, Dial, Endpoint, FaultOdds, FaultPlan, FaultSwitch, Pace, TransportError, faulty_pair,
};
use oracle::Witness;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use tap::{Log, Tap};
use tokio::time::{Duration, Instant, sleep_until};

/// Schedules in an ordinary run.
const SCHEDULES: u64 = 5_000;
/// Virtual time with faults, and without, for the link to come back.
const FAULTY: Duration = Duration::from_millis(1500);
const QUIET: Duration = Duration::from_millis(3500);

/// Opens faulty wires to one hand.
struct FaultyDial {
    hand: SharedHand,
    log: Log,
    plan: FaultPlan,
    quirks: Quirks,
    protocol: Protocol,
    state: Mutex<DialState>,
}

#[derive(Default)]
struct DialState {
    dials: u64,
    quiet: bool,
    away: bool,
    switch: Option<FaultSwitch>,
}

impl FaultyDial {
    /// No faults from now on, on this wire and on all later ones.
    fn quiet(&self) {
        let mut state = self.state.lock().unwrap();
        state.quiet = true;
        self.quirks.one_in.store(0, Ordering::Relaxed);
        state.away = false;
        if let Some(switch) = &state.switch {
            switch.quiet();
        }
    }

    /// Cuts the wire; while it is away nothing can be dialled.
    fn cut(&self, away: bool) {
        let mut state = self.state.lock().unwrap();
        state.away = away;
        if let Some(switch) = &state.switch {
            switch.hang_up();
        }
    }
}

impl Dial for FaultyDial {
    fn dial(&self, _: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let mut state = self.state.lock().unwrap();
        if state.away {
            let missing = TransportError::Missing {
                place: "test".into(),
            };
            return futures::future::ready(Err(missing)).boxed();
        }
        state.dials += 1;
        let plan = FaultPlan {
            seed: self.plan.seed.wrapping_mul(31).wrapping_add(state.dials),
            ..self.plan
        };
        let (near, far, switch) = faulty_pair(plan);
        let quirks = self.quirks.clone();
        if state.quiet {
            switch.quiet();
        }
        state.switch = Some(switch);
        let hand = self.hand.clone();
        match self.protocol {
            Protocol::Rs485 => tokio::spawn(device::rs485(hand, far, quirks)),
            Protocol::Rtu => tokio::spawn(device::modbus_rtu(hand, far, quirks, plan.seed)),
            Protocol::Tcp => tokio::spawn(device::modbus_tcp(hand, far, quirks, plan.seed)),
        };
        let wire: BoxedWire = Box::new(Tap::new(near, self.log.clone(), self.protocol));
        futures::future::ready(Ok(wire)).boxed()
    }
}

fn odds(rng: &mut fastrand::Rng, protocol: Protocol) -> FaultOdds {
    let mut chance = |most: f64| if rng.bool() { rng.f64() * most } else { 0.0 };
    let (delay, hang_up) = (chance(0.1), chance(0.004));
    if protocol == Protocol::Tcp {
        // TCP loses and changes nothing; it delays and breaks.
        return FaultOdds {
            delay,
            hang_up,
            ..FaultOdds::default()
        };
    }
    let (drop, corrupt) = (chance(0.15), chance(0.15));
    // A cut frame and its double make one frame of wrong bytes, which the 8-bit sum passes once in 256.
    let (truncate, duplicate) = if rng.bool() {
        (rng.f64() * 0.1, 0.0)
    } else {
        (0.0, rng.f64() * 0.2)
    };
    FaultOdds {
        drop,
        delay,
        corrupt,
        truncate,
        duplicate,
        hang_up,
    }
}

/// One schedule, from connecting under faults to the recovery after them.
struct Schedule {
    rng: fastrand::Rng,
    clock: Clock,
    hand: SharedHand,
    dial: Arc<FaultyDial>,
    link: LinkHandle,
    witness: Witness,
}

impl Schedule {
    fn new(seed: u64) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let clock = Clock::start();
        let protocol = [Protocol::Rs485, Protocol::Rtu, Protocol::Tcp][rng.usize(..3)];
        let is_tcp = protocol == Protocol::Tcp;
        if std::env::var_os("HANDSCOPE_SEED").is_some() {
            println!("seed {seed}: {protocol:?}");
        }
        let config = SimConfig {
            seed,
            id: 1,
            scenario: Scenario::Idle,
            personality: Personality::default(),
        };
        let hand = SharedHand::new(SimHand::new(config), Instant::now());
        let turnaround = Duration::from_micros(rng.u64(1_000..15_000));
        let one_in = if protocol != Protocol::Rs485 && rng.bool() {
            rng.u32(4..40)
        } else {
            0
        };
        let pace = [None, Some(115_200), Some(921_600)][rng.usize(..3)].map(|baud| Pace { baud });
        let pace = if is_tcp { None } else { pace };
        let plan = FaultPlan {
            seed,
            out: odds(&mut rng, protocol),
            back: odds(&mut rng, protocol),
            delay_max: Duration::from_millis(rng.u64(1..900)),
            // The framing's 8-bit sum lets one in 15 double flips pass; what it must catch is a single one.
            flips_max: 1,
            pace,
        };
        let log = Log::new(clock);
        let dial = Arc::new(FaultyDial {
            hand: hand.clone(),
            log: log.clone(),
            plan,
            quirks: Quirks {
                turnaround,
                one_in: Arc::new(one_in.into()),
            },
            protocol,
            state: Mutex::default(),
        });
        let endpoint: Endpoint = match (protocol, pace) {
            (Protocol::Tcp, _) => "tcp:test".parse().unwrap(),
            (Protocol::Rs485, None) => "sim:".parse().unwrap(),
            (Protocol::Rtu, None) => "rtu:test".parse().unwrap(),
            (Protocol::Rs485, Some(pace)) => {
                format!("rs485:test?baud={}", pace.baud).parse().unwrap()
            }
            (Protocol::Rtu, Some(pace)) => format!("rtu:test?baud={}", pace.baud).parse().unwrap(),
        };
        let rates = if rng.u8(..8) == 0 {
            PollRates::FULL
        } else {
            PollRates::default()
        };
        let config = LinkConfig {
            endpoint,
            rates,
            clock,
            dial: dial.clone(),
            wake: Arc::new(|| ()),
        };
        let link = link::open(config, &tokio::runtime::Handle::current());
        Self {
            rng,
            clock,
            hand,
            dial,
            link,
            witness: Witness::new(seed, log),
        }
    }

    async fn run(mut self) -> oracle::Seen {
        let end = Instant::now() + FAULTY;
        while Instant::now() < end {
            let pause = Duration::from_millis(self.rng.u64(1..120));
            self.drain_for(pause).await;
            self.act();
        }
        self.dial.quiet();
        self.hand
            .with(|hand, now| hand.write(1004, &[1], now))
            .unwrap();
        self.drain_for(QUIET).await;
        self.witness.finish(&self.link, self.clock.now());
        self.witness.seen
    }

    /// Takes events for a while, each as it comes.
    async fn drain_for(&mut self, length: Duration) {
        let until = Instant::now() + length;
        loop {
            let event = tokio::select! {
                biased;
                event = self.link.event() => event.expect("the session lives as long as its handle"),
                () = sleep_until(until) => return,
            };
            self.witness.event(&event, self.clock.now());
            if let LinkEvent::State {
                state: LinkState::Armed,
                ..
            } = event
            {
                self.set();
            }
        }
    }

    /// Something that a person or the world does.
    fn act(&mut self) {
        match self.rng.u8(..20) {
            0..=4 => self.arm(),
            5..=9 => self.set(),
            10..=12 => self.stop(),
            13 => self.link.disarm(),
            14 => self.ask(Request::Command(HandCommand::ClearErrors)),
            15 => self.ask(Request::Command(HandCommand::Gesture(
                Gesture::MIN,
                GestureRoute::Register1008,
            ))),
            16 => {
                let len = self.rng.u16(1..60);
                self.ask(Request::Read(Span::new(1000, len)));
            }
            17 => self
                .hand
                .with(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall)),
            18 => self.dial.cut(self.rng.bool()),
            _ => {
                self.arm();
                self.stop();
            }
        }
    }

    fn arm(&mut self) {
        self.witness.seen.arm_asks += 1;
        let (speed, force) = (PerDof::splat(Speed::GENTLE), PerDof::splat(Force::GENTLE));
        self.link.arm(ArmRequest { speed, force });
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
        self.link.set(&wish);
    }

    fn stop(&mut self) {
        self.witness.stop_pressed(&self.link, self.clock.now());
        self.link.stop();
    }

    fn ask(&mut self, request: Request) {
        if let Ok(ticket) = self.link.ask(request) {
            self.witness.asked(ticket, request);
        }
    }
}

fn run_seed(seed: u64) -> oracle::Seen {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_time()
        .start_paused(true)
        .build()
        .unwrap();
    runtime.block_on(async { Schedule::new(seed).run().await })
}

#[test]
fn every_seeded_schedule_keeps_the_rules() {
    if let Ok(seed) = std::env::var("HANDSCOPE_SEED") {
        println!("{:#?}", run_seed(seed.parse().unwrap()));
        return;
    }
    let schedules = std::env::var("HANDSCOPE_SCHEDULES").map_or(SCHEDULES, |n| n.parse().unwrap());
    let next = AtomicU64::new(0);
    let all = Mutex::new(oracle::Seen::default());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= schedules {
                        return;
                    }
                    let seen = std::panic::catch_unwind(|| run_seed(seed));
                    let seen = seen.unwrap_or_else(|_| panic!("replay with HANDSCOPE_SEED={seed}"));
                    all.lock().unwrap().add(&seen);
                }
            });
        }
    });
    let seen = all.into_inner().unwrap();
    println!("{seen:#?}");
    // Oracles that never had anything to judge prove nothing.
    assert!(seen.fresh_states > schedules * 20, "{seen:?}");
    assert!(seen.fresh_tips > schedules * 5, "{seen:?}");
    assert!(seen.setpoint_frames > schedules / 2, "{seen:?}");
    assert!(seen.stops_seen > schedules / 2, "{seen:?}");
    assert!(seen.confirmed > schedules / 8, "{seen:?}");
    assert!(seen.losses > schedules / 2, "{seen:?}");
    assert!(seen.disturbed > schedules, "{seen:?}");
}

/// Opens a clean paced wire to a hand that rests, and waits until it is armed.
async fn armed_on(baud: u32, turnaround: Duration) -> (LinkHandle, Log, Clock) {
    let clock = Clock::start();
    let hand = SharedHand::new(SimHand::new(SimConfig::default()), Instant::now());
    let log = Log::new(clock);
    let plan = FaultPlan {
        pace: Some(Pace { baud }),
        ..FaultPlan::quiet(1)
    };
    let dial = Arc::new(FaultyDial {
        hand,
        log: log.clone(),
        plan,
        quirks: Quirks {
            turnaround,
            ..Quirks::default()
        },
        protocol: Protocol::Rs485,
        state: Mutex::default(),
    });
    let config = LinkConfig {
        endpoint: format!("rs485:test?baud={baud}").parse().unwrap(),
        rates: PollRates::default(),
        clock,
        dial,
        wake: Arc::new(|| ()),
    };
    let mut link = link::open(config, &tokio::runtime::Handle::current());
    loop {
        match link.event().await.unwrap() {
            LinkEvent::Sample { .. } if link.status().state == LinkState::Monitoring => {
                let (speed, force) = (PerDof::splat(Speed::GENTLE), PerDof::splat(Force::GENTLE));
                link.arm(ArmRequest { speed, force });
            }
            LinkEvent::State {
                state: LinkState::Armed,
                ..
            } => return (link, log, clock),
            _ => {}
        }
    }
}

/// Ten thousand slider events in a second, as fast as a program can make them.
async fn drag(link: &mut LinkHandle) -> i16 {
    let epoch = link.status().armed.unwrap();
    let end = Instant::now() + Duration::from_secs(1);
    let mut last = 0;
    for step in 0..10_000u32 {
        sleep_until(end - Duration::from_micros(100) * (10_000 - step)).await;
        last = i16::try_from(400 + step % 500).unwrap();
        let mut wish = Setpoints::none(epoch);
        wish.angle[Dof::Index] = Some(Target::Go(Angle::nearest(last)));
        link.set(&wish);
        while link.try_event().is_some() {}
    }
    last
}

#[tokio::test(start_paused = true)]
async fn ten_thousand_slider_events_are_few_writes_and_the_last_is_sent() {
    let (mut link, log, _) = armed_on(115_200, Duration::from_millis(3)).await;
    let before = log.sent().len();
    let last = drag(&mut link).await;
    tokio::time::sleep(Duration::from_millis(200)).await;
    let sent = log.sent().split_off(before);
    let writes: Vec<_> = sent
        .iter()
        .filter_map(|frame| frame.written.as_ref())
        .collect();
    assert!((20..=51).contains(&writes.len()), "{}", writes.len());
    assert_eq!(writes.last().unwrap()[6..8], last.to_le_bytes());
}

#[tokio::test(start_paused = true)]
async fn a_drag_on_the_slowest_line_leaves_the_pose_fresh_and_the_hand_armed() {
    let (mut link, log, _) = armed_on(19_200, Duration::from_millis(15)).await;
    let before = log.sent().len();
    drag(&mut link).await;
    assert_eq!(link.status().state, LinkState::Armed);
    let sent = log.sent().split_off(before);
    let reads = sent.iter().filter(|frame| frame.written.is_none()).count();
    let writes = sent.len() - reads;
    assert!(
        reads >= writes.saturating_sub(1) && writes > 3,
        "{reads} reads, {writes} writes"
    );
}
