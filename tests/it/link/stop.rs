//! How long a stop takes from the press to the last byte of the first hold frame, in virtual time, on lines that take
//! their time: all wires, all bauds, hands of 3 to 15 ms, at rest, in the hands of another controller, and while a
//! person drags. `HANDSCOPE_SOAK=1` runs all.

use crate::setup::hand;
use crate::setup::link::{self, Client};
use crate::setup::soak;
use crate::setup::time::in_virtual_time;
use futures::FutureExt as _;
use handscope::codec::can::{CanFunction, CanId, CanRecord, frame, from_record, to_record};
use handscope::hand::Setpoints;
use handscope::hand::{Angle, Dof, Span, Target};
use handscope::link::{LinkConfig, PollRates};
use handscope::record::{LinkState, Record};
use handscope::sim::{Scenario, SharedHand, SimConfig};
use handscope::transport::{Pipe, pair};
use std::ops::RangeInclusive;
use std::sync::{Arc, Mutex};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Duration, Instant, sleep, sleep_until, timeout_at};

const SEEDS: u64 = 12;
/// Presses in one run.
const PRESSES: u32 = 4;
const ANGLE_SET: u16 = 1486;
/// Longest reply frame on a serial line while something moves: three fingertips.
const MOVING_FRAME: usize = 182;

/// What is spoken, and how fast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Protocol {
    Rs485(u32),
    Rtu(u32),
    Tcp,
    Can,
}

impl Protocol {
    fn endpoint(self) -> String {
        match self {
            Self::Rs485(baud) => format!("rs485:test?baud={baud}"),
            Self::Rtu(baud) => format!("rtu:test?baud={baud}"),
            Self::Tcp => "tcp:test".into(),
            Self::Can => "can:test".into(),
        }
    }

    /// Time of these bytes on the wire: ten bits each on a serial line; a CAN frame of 8 bytes has 130 bits and more.
    fn time(self, bytes: usize) -> Duration {
        let bytes = u32::try_from(bytes).unwrap();
        match self {
            Self::Rs485(baud) | Self::Rtu(baud) => Duration::from_secs(10) * bytes / baud,
            Self::Tcp => Duration::ZERO,
            Self::Can => Duration::from_micros(160),
        }
    }
}

/// One transaction on the line.
#[derive(Debug, Clone, Copy)]
struct Entry {
    began: Instant,
    /// The request's last byte.
    asked: Instant,
    /// The reply's last byte.
    answered: Instant,
    address: u16,
    is_write: bool,
    reply_len: usize,
}

/// A half-duplex line with a hand at its end. It takes no byte while a transaction is under way.
struct Line {
    hand: SharedHand,
    wire: Pipe,
    protocol: Protocol,
    turnaround: RangeInclusive<u64>,
    rng: fastrand::Rng,
    journal: Arc<Mutex<Vec<Entry>>>,
}

impl Line {
    async fn run(mut self) {
        let mut chunk = [0; 512];
        while let Ok(len @ 1..) = self.wire.read(&mut chunk).await {
            let began = Instant::now();
            let request = chunk[..len].to_vec();
            let (address, is_write, reply) = answer(&self.hand, self.protocol, &request);
            let turnaround = Duration::from_micros(self.rng.u64(self.turnaround.clone()));
            let asked = began + self.protocol.time(len);
            let answered = asked + turnaround + self.protocol.time(reply.len());
            self.journal.lock().unwrap().push(Entry {
                began,
                asked,
                answered,
                address,
                is_write,
                reply_len: reply.len(),
            });
            sleep_until(answered).await;
            let trampled = self.wire.read(&mut chunk).now_or_never();
            assert!(
                !matches!(trampled, Some(Ok(1..))),
                "{:?} was talked over",
                self.protocol
            );
            if matches!(trampled, Some(Ok(0))) || self.wire.write_all(&reply).await.is_err() {
                return;
            }
        }
    }
}

/// What a request names, and the hand's reply to it, by the manual's sections 2.2 to 2.5.
fn answer(hand: &SharedHand, protocol: Protocol, request: &[u8]) -> (u16, bool, Vec<u8>) {
    match protocol {
        Protocol::Rs485(_) => rs485(hand, request),
        Protocol::Rtu(_) => {
            let (address, is_write, pdu) = modbus(hand, &request[1..request.len() - 2]);
            let mut reply = vec![1];
            reply.extend(pdu);
            reply.extend(crc(&reply));
            (address, is_write, reply)
        }
        Protocol::Tcp => {
            let (address, is_write, pdu) = modbus(hand, &request[7..]);
            let mut reply = vec![request[0], request[1], 0, 0, 0];
            reply.extend([u8::try_from(pdu.len() + 1).unwrap(), request[6]]);
            reply.extend(pdu);
            (address, is_write, reply)
        }
        Protocol::Can => can(hand, request),
    }
}

fn read(hand: &SharedHand, address: u16, len: u16) -> Vec<u8> {
    hand.with(|hand, now| hand.read(Span::new(address, len), now))
        .unwrap()
}

fn write(hand: &SharedHand, address: u16, bytes: &[u8]) {
    hand.with(|hand, now| hand.write(address, bytes, now))
        .unwrap();
}

fn rs485(hand: &SharedHand, request: &[u8]) -> (u16, bool, Vec<u8>) {
    let [0xEB, 0x90, 1, _, command, low, high, data @ .., _sum] = request else {
        panic!("{request:02X?}")
    };
    let address = u16::from_le_bytes([*low, *high]);
    let is_write = *command == 0x12;
    let bytes = if is_write {
        write(hand, address, data);
        vec![1]
    } else {
        read(hand, address, u16::from(data[0]))
    };
    let mut reply = vec![
        0x90,
        0xEB,
        1,
        u8::try_from(bytes.len() + 3).unwrap(),
        *command,
        *low,
        *high,
    ];
    reply.extend(bytes);
    reply.push(
        reply[2..]
            .iter()
            .fold(0, |sum: u8, byte| sum.wrapping_add(*byte)),
    );
    (address, is_write, reply)
}

fn modbus(hand: &SharedHand, pdu: &[u8]) -> (u16, bool, Vec<u8>) {
    let address = u16::from_be_bytes([pdu[1], pdu[2]]);
    let swapped = |bytes: &[u8]| {
        bytes
            .chunks(2)
            .flat_map(|pair| [pair[1], pair[0]])
            .collect::<Vec<u8>>()
    };
    match pdu[0] {
        3 => {
            let bytes = read(hand, address, u16::from_be_bytes([pdu[3], pdu[4]]) * 2);
            let mut reply = vec![3, u8::try_from(bytes.len()).unwrap()];
            reply.extend(swapped(&bytes));
            (address, false, reply)
        }
        16 => {
            write(hand, address, &swapped(&pdu[6..]));
            (address, true, pdu[..5].to_vec())
        }
        other => panic!("function {other}"),
    }
}

fn crc(bytes: &[u8]) -> [u8; 2] {
    let mut register = 0xFFFFu16;
    for byte in bytes {
        register ^= u16::from(*byte);
        for _ in 0..8 {
            register = (register >> 1) ^ if register % 2 == 1 { 0xA001 } else { 0 };
        }
    }
    register.to_le_bytes()
}

fn can(hand: &SharedHand, request: &[u8]) -> (u16, bool, Vec<u8>) {
    let CanRecord::Frame(asked) = from_record(request.try_into().unwrap()) else {
        panic!("{request:02X?}")
    };
    let id = CanId::from_raw(asked.id).unwrap();
    let data = match id.way {
        CanFunction::Read => read(hand, id.address, u16::from(asked.data[0])),
        CanFunction::Write => {
            write(hand, id.address, &asked.data);
            vec![1]
        }
    };
    let reply = frame(id.way, id.hand, id.address, &data).unwrap();
    (
        id.address,
        id.way == CanFunction::Write,
        to_record(&reply).to_vec(),
    )
}

/// What the hand is about when stop is pressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scene {
    /// Nobody moves it.
    Rest,
    /// Another controller grasps with it.
    Moved,
    /// A person armed it and drags.
    Dragged,
}

struct Stage {
    link: Client,
    journal: Arc<Mutex<Vec<Entry>>>,
    scene: Scene,
    /// A reply's length takes time: not so over TCP.
    has_line_time: bool,
    rng: fastrand::Rng,
}

impl Stage {
    async fn live(
        protocol: Protocol,
        scene: Scene,
        turnaround: RangeInclusive<u64>,
        seed: u64,
    ) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let scenario = if scene == Scene::Moved {
            Scenario::Grasp
        } else {
            Scenario::Idle
        };
        let config = SimConfig {
            seed,
            scenario,
            ..SimConfig::default()
        };
        let journal = Arc::<Mutex<Vec<Entry>>>::default();
        let line = Line {
            hand: hand::shared(config),
            wire: pair().0,
            protocol,
            turnaround,
            rng: rng.fork(),
            journal: Arc::clone(&journal),
        };
        let line = Mutex::new(Some(line));
        let dial = link::behind(move |endpoint, far| {
            let Some(mut line) = line.lock().unwrap().take() else {
                panic!("{endpoint} was lost")
            };
            line.wire = far;
            tokio::spawn(line.run());
        });
        let link = link::open(LinkConfig {
            rates: PollRates::FULL,
            ..link::config(&protocol.endpoint(), dial)
        });
        let mut stage = Self {
            link,
            journal,
            scene,
            has_line_time: protocol != Protocol::Tcp,
            rng,
        };
        stage.until(LinkState::Monitoring).await;
        stage
    }

    async fn until(&mut self, wanted: LinkState) {
        let end = Instant::now() + Duration::from_secs(20);
        while self.link.status().state != wanted {
            timeout_at(end, self.link.records.next())
                .await
                .expect("in time")
                .unwrap();
        }
    }

    /// Lets time pass; while a person drags, with a slider event each 5 ms.
    async fn pass(&mut self, length: Duration) {
        let end = Instant::now() + length;
        while Instant::now() < end {
            if let Some(epoch) = self
                .link
                .status()
                .armed
                .filter(|_| self.scene == Scene::Dragged)
            {
                let mut wish = Setpoints::none(epoch);
                wish.angle[Dof::Index] = Some(Target::Go(Angle::nearest(self.rng.i16(200..800))));
                self.link.set(&wish);
            }
            sleep(Duration::from_millis(5).min(end - Instant::now())).await;
            while self.link.records.try_next().is_some() {}
        }
    }

    async fn arm(&mut self) {
        let request = link::gentle();
        let end = Instant::now() + Duration::from_secs(20);
        while self.link.status().state != LinkState::Armed {
            assert!(Instant::now() < end, "{:?}", self.link.status());
            self.link.arm(request);
            let mut event = self.link.records.next().await;
            while !matches!(
                event,
                Some(Record::State { .. } | Record::ArmRefused { .. }) | None
            ) {
                event = self.link.records.next().await;
            }
        }
    }

    /// Presses stop at a random instant and gives the time to the last byte of the first hold frame.
    async fn press(&mut self) -> Duration {
        let pause = Duration::from_micros(self.rng.u64(600_000..1_400_000));
        self.pass(pause).await;
        let before = self.journal.lock().unwrap().len();
        self.check_moving(before);
        let pressed = Instant::now();
        self.link.stop();
        self.pass(Duration::from_millis(250)).await;
        let journal = self.journal.lock().unwrap();
        let after = &journal[before..];
        assert!(
            after[0].is_write && after[0].address == ANGLE_SET,
            "the hold is next: {after:?}"
        );
        // Six angles are 12 bytes, which CAN carries in two frames.
        let last = after
            .iter()
            .take_while(|entry| entry.is_write)
            .take(2)
            .last()
            .unwrap();
        let last = if last.address == ANGLE_SET + 8 {
            last
        } else {
            &after[0]
        };
        last.asked - pressed
    }

    /// While a person drags or something moved just now, no reply on a serial line is longer than three fingertips.
    fn check_moving(&self, before: usize) {
        if self.scene == Scene::Dragged && self.has_line_time {
            let journal = self.journal.lock().unwrap();
            for entry in &journal[before.saturating_sub(10)..before] {
                assert!(
                    entry.reply_len <= MOVING_FRAME || entry.address < 1000,
                    "{entry:?}"
                );
            }
        }
    }
}

async fn stop_times(
    protocol: Protocol,
    scene: Scene,
    turnaround: RangeInclusive<u64>,
    seed: u64,
) -> Duration {
    let mut stage = Stage::live(protocol, scene, turnaround, seed).await;
    let mut worst = Duration::ZERO;
    // Long enough to have learnt how quick the hand is.
    stage.pass(Duration::from_secs(3)).await;
    for _ in 0..PRESSES {
        if scene == Scene::Dragged {
            stage.until(LinkState::Monitoring).await;
            stage.arm().await;
        }
        worst = worst.max(stage.press().await);
        let end = Instant::now() + Duration::from_secs(3);
        while stage.link.status().state == LinkState::Holding && Instant::now() < end {
            stage.pass(Duration::from_millis(50)).await;
        }
    }
    let journal = stage.journal.lock().unwrap();
    for pair in journal.windows(2) {
        assert!(pair[1].began >= pair[0].answered, "talked over: {pair:?}");
    }
    worst
}

fn check(protocol: Protocol, limit_ms: u64, slowest_ms: u64) {
    let seeds = soak::times_at_least(3, SEEDS);
    let limit = Duration::from_millis(limit_ms);
    for scene in [Scene::Rest, Scene::Moved, Scene::Dragged] {
        let mut worst = Duration::ZERO;
        for seed in 0..seeds {
            let slowest = slowest_ms * 1000;
            // The slowest hand, a quick one, and one that takes now this long and now that long.
            let turnaround = match seed % 3 {
                0 => slowest..=slowest,
                1 => slowest.min(3000)..=slowest.min(3000),
                _ => slowest.min(3000)..=slowest,
            };
            let took = in_virtual_time(stop_times(protocol, scene, turnaround, seed));
            assert!(
                took <= limit,
                "{protocol:?}, {scene:?}, seed {seed}: a stop took {took:?}"
            );
            worst = worst.max(took);
        }
        println!("{protocol:?}, {scene:?}: a stop takes {worst:?} at most, of {limit:?}");
        assert!(
            worst > limit / 8,
            "{protocol:?}: nothing was ever in flight"
        );
    }
}

/// Motion states and sweeps over all fingertips a second while something moves.
async fn rates(scene: Scene, rates: PollRates) -> (f64, f64) {
    let protocol = Protocol::Rs485(115_200);
    let mut stage = Stage::live(protocol, scene, 6000..=6000, 1).await;
    stage.link.read_at(rates);
    stage.pass(Duration::from_secs(3)).await;
    if scene == Scene::Dragged {
        stage.arm().await;
    }
    let mut least = (f64::INFINITY, f64::INFINITY);
    for second in 0..8 {
        stage.pass(Duration::from_secs(1)).await;
        let stats = stage.link.stats();
        if second > 2 {
            least.0 = least.0.min(stats.state_hz);
            least.1 = least.1.min(stats.tactile_hz);
        }
    }
    least
}

#[test]
fn while_the_hand_moves_at_115200_baud_touch_comes_at_10_hz_and_the_state_at_25() {
    // Setpoints as fast as the line takes them are a third of what a drag asks for.
    for (scene, state_hz, touch_hz) in [(Scene::Moved, 25.0, 10.0), (Scene::Dragged, 24.0, 9.0)] {
        let (state, touch) = in_virtual_time(rates(scene, PollRates::default()));
        println!("{scene:?}: state {state:.1} Hz, touch {touch:.1} Hz");
        assert!(
            state >= state_hz && touch >= touch_hz,
            "{scene:?}: {state} {touch}"
        );
    }
}

#[test]
fn at_115200_baud_a_stop_is_on_the_wire_within_30_ms() {
    check(Protocol::Rs485(115_200), 30, 15);
    check(Protocol::Rtu(115_200), 30, 15);
}

#[test]
fn at_57600_baud_within_45_ms() {
    check(Protocol::Rs485(57_600), 45, 15);
    check(Protocol::Rtu(57_600), 45, 15);
}

#[test]
fn at_19200_baud_within_90_ms() {
    check(Protocol::Rs485(19_200), 90, 15);
    check(Protocol::Rtu(19_200), 90, 15);
}

#[test]
fn at_921600_baud_within_20_ms() {
    check(Protocol::Rs485(921_600), 20, 15);
    check(Protocol::Rtu(921_600), 20, 15);
}

#[test]
fn over_modbus_tcp_within_25_ms() {
    check(Protocol::Tcp, 25, 15);
}

/// Each frame of the bus waits for the hand by itself, so that a slower hand could not keep to it.
#[test]
fn over_can_within_10_ms_with_hands_of_up_to_3_ms() {
    check(Protocol::Can, 10, 3);
}
