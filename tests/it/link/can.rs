//! The link over CAN in virtual time: through two adapters' text and packets and through Linux's frames, with good and odd
//! adapters, and with replies that come late or twice. Frames are checked by the manual's rules, not by our encoder.

use crate::setup::hand::{numbered, shared};
use crate::setup::link::{self, Client, ended, live, pass};
use handscope::hand::Setpoints;
use handscope::hand::{
    Angle, Dof, Force, HandCommand, Moment, PerDof, Register, Speed, Target, register,
};
use handscope::link::{ArmRequest, Clock, LinkConfig, LinkTrouble, RequestError};
use handscope::record::{LinkState, Record};
use handscope::sim::SharedHand;
use handscope::sim::serve::{can, slcan, usbcan};
use handscope::transport::{Pipe, TransportError, pair};
use std::sync::{Arc, Mutex};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Duration, Instant, sleep};

fn connect(endpoint: &str, far: impl Fn(Pipe) + Send + Sync + 'static) -> Client {
    link::connect(endpoint, link::behind(move |_, pipe| far(pipe)))
}

async fn read(link: &mut Client, register: &Register) -> Result<Vec<u8>, RequestError> {
    ended(link.read(register.span())).await
}

async fn trouble(link: &Client) -> LinkTrouble {
    for _ in 0..10_000 {
        if let Some(trouble) = link.status().trouble {
            return trouble;
        }
        sleep(Duration::from_millis(1)).await;
    }
    panic!("no trouble");
}

/// All ways to the simulated hand.
fn each(hand: &SharedHand, id: u8) -> [Client; 3] {
    ["slcan", "usbcan", "can"].map(|kind| {
        let endpoint = format!("{kind}:test?id={id}");
        link::connect(&endpoint, link::to_hand(hand.clone()))
    })
}

#[tokio::test(start_paused = true)]
async fn everything_is_read_in_pieces_at_the_wanted_rates() {
    let hand = shared(numbered(7));
    for mut link in each(&hand, 7) {
        live(&mut link).await;
        pass(&mut link, Duration::from_secs(2)).await;
        let stats = link.stats();
        assert!(stats.state_reads > 150, "{stats:?}");
        assert!(stats.tactile_reads > 45, "{stats:?}");
        assert_eq!(stats.timeouts + stats.foreign_replies + stats.resyncs, 0);
        assert_eq!(read(&mut link, &register::HAND_ID).await, Ok(vec![7]));
        let angles = read(&mut link, &register::ANGLE_ACT).await.unwrap();
        let wanted = hand.with(|hand, now| hand.read(register::ANGLE_ACT.span(), now).unwrap());
        assert_eq!(angles, wanted);
    }
}

#[tokio::test(start_paused = true)]
async fn setpoints_arrive_whole_though_six_shorts_take_two_frames() {
    let hand = shared(numbered(1));
    for (mut link, angle) in each(&hand, 1).into_iter().zip([400, 700, 550]) {
        live(&mut link).await;
        pass(&mut link, Duration::from_millis(200)).await;
        link.arm(ArmRequest {
            speed: PerDof::splat(Speed::nearest(300)),
            force: PerDof::splat(Force::GENTLE),
        });
        let armed = LinkState::Armed;
        let is_armed =
            |record: &Record| matches!(record, Record::State { state, .. } if *state == armed);
        link::record(&mut link, is_armed).await;
        link.set(&Setpoints {
            epoch: link.status().armed.unwrap(),
            angle: PerDof::splat(Some(Target::Go(Angle::nearest(angle)))),
            force: PerDof::splat(None),
            speed: PerDof::splat(None),
        });
        pass(&mut link, Duration::from_millis(500)).await;
        let held = hand.with(|hand, now| hand.read(register::ANGLE_SET.span(), now).unwrap());
        assert_eq!(held, (angle as u16).to_le_bytes().repeat(6));
        let speeds = hand.with(|hand, now| hand.read(register::SPEED_SET.span(), now).unwrap());
        assert_eq!(speeds, 300_u16.to_le_bytes().repeat(6));
        let longest = hand.with(|hand, _| hand.journal().iter().map(|e| e.bytes.len()).max());
        assert!(longest <= Some(8));
        link.stop();
        pass(&mut link, Duration::from_millis(500)).await;
        link.disarm();
        let cleared = ended(link.write(HandCommand::ClearErrors)).await;
        assert!(cleared.is_ok(), "{cleared:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn nobody_asks_for_the_gap_on_can_where_each_piece_is_a_request_of_its_own() {
    let asked = Arc::new(Mutex::new(Vec::new()));
    let (hand, seen) = (shared(numbered(1)), Arc::clone(&asked));
    let mut link = connect("can:test", move |mut near| {
        let (hand, seen) = (hand.clone(), Arc::clone(&seen));
        tokio::spawn(async move {
            let (mut far, sim) = pair();
            tokio::spawn(can::serve(hand, sim));
            let mut record = [0; 16];
            while near.read_exact(&mut record).await.is_ok() {
                let id = u32::from_ne_bytes([record[0], record[1], record[2], record[3]]);
                let address = (id >> 14) & 0xFFF;
                seen.lock()
                    .unwrap()
                    .push(address..address + u32::from(record[8]));
                far.write_all(&record).await.unwrap();
                far.read_exact(&mut record).await.unwrap();
                near.write_all(&record).await.unwrap();
            }
        });
    });
    live(&mut link).await;
    pass(&mut link, Duration::from_secs(2)).await;
    let asked = asked.lock().unwrap();
    assert!(asked.len() > 100, "{}", asked.len());
    let mut in_gap = asked
        .iter()
        .filter(|run| run.start < 1582 && 1558 < run.end);
    assert_eq!(in_gap.next(), None);
    assert_eq!(link.status().quirks.gap, None);
}

/// The maker's adapter, which also gives back what it is sent, or damages every seventh packet of the hand.
async fn makers(echoes: bool, hand: SharedHand, mut near: Pipe) {
    let (mut far, sim) = pair();
    tokio::spawn(usbcan::serve(hand, sim));
    let (mut asked, mut said) = (vec![0; 64], vec![0; 64]);
    let mut count = 0;
    while let Ok(len @ 1..) = near.read(&mut asked).await {
        if echoes {
            near.write_all(&asked[..len]).await.unwrap();
        }
        far.write_all(&asked[..len]).await.unwrap();
        let len = far.read(&mut said).await.unwrap();
        count += 1;
        if !echoes && count % 7 == 0 {
            // A length of 16 more.
            said[len - 7] ^= 16;
        }
        near.write_all(&said[..len]).await.unwrap();
    }
}

#[tokio::test(start_paused = true)]
async fn the_makers_adapter_may_echo_and_damaged_packets_are_counted_and_never_shown() {
    for echoes in [true, false] {
        let hand = shared(numbered(7));
        let mut link = connect("usbcan:test?id=7", move |far| {
            tokio::spawn(makers(echoes, hand.clone(), far));
        });
        live(&mut link).await;
        pass(&mut link, Duration::from_secs(2)).await;
        let stats = link.stats();
        assert!(stats.state_reads > 5, "{stats:?}");
        assert_eq!(stats.timeouts == 0, echoes, "{stats:?}");
        assert_eq!(stats.checksum_errors > 5, !echoes, "{stats:?}");
        assert_eq!(stats.foreign_requests, 0, "{stats:?}");
    }
}

/// What an odd adapter does.
#[derive(Clone, Copy, Default)]
struct Oddity {
    /// Sends each frame back before anything else.
    echoes: bool,
    /// Acknowledges nothing.
    mute: bool,
    /// Adds time stamps to frames.
    stamps: bool,
    /// Says BEL to what begins with this.
    refuses: Option<u8>,
    /// Nobody is on the bus.
    alone: bool,
}

/// An adapter in front of the simulated one, that knows lines and nothing else.
async fn odd(oddity: Oddity, hand: SharedHand, mut near: Pipe) {
    let (mut far, sim) = pair();
    tokio::spawn(slcan::serve(hand, sim));
    let mut line = Vec::new();
    let mut back = Vec::new();
    loop {
        tokio::select! {
            biased;
            byte = far.read_u8() => {
                let Ok(byte) = byte else { return };
                back.push(byte);
                if byte != b'\r' && byte != 7 {
                    continue;
                }
                let is_frame = back[0] == b'T';
                if is_frame && oddity.stamps {
                    back.splice(back.len() - 1.., *b"12Ab\r");
                }
                if (is_frame && !oddity.alone) || (!is_frame && !oddity.mute) {
                    near.write_all(&back).await.unwrap();
                }
                back.clear();
            }
            byte = near.read_u8() => {
                let Ok(byte) = byte else { return };
                line.push(byte);
                if byte != b'\r' {
                    continue;
                }
                if oddity.refuses == Some(line[0]) {
                    near.write_all(b"\x07").await.unwrap();
                } else {
                    if oddity.echoes && line[0] == b'T' {
                        near.write_all(&line).await.unwrap();
                    }
                    far.write_all(&line).await.unwrap();
                }
                line.clear();
            }
        }
    }
}

fn through(oddity: Oddity, id: u8) -> Client {
    let hand = shared(numbered(id));
    connect(&format!("slcan:test?id={id}"), move |far| {
        tokio::spawn(odd(oddity, hand.clone(), far));
    })
}

#[tokio::test(start_paused = true)]
async fn echoes_silent_adapters_and_time_stamps_are_coped_with() {
    for (echoes, mute, stamps) in [
        (true, false, false),
        (false, true, false),
        (true, true, true),
    ] {
        let oddity = Oddity {
            echoes,
            mute,
            stamps,
            ..Oddity::default()
        };
        let mut link = through(oddity, 7);
        live(&mut link).await;
        // The request for this one byte looks like the answer of a hand with id 1.
        assert_eq!(read(&mut link, &register::HAND_ID).await, Ok(vec![7]));
        // The request and the reply of this write are the same frame.
        let cleared = ended(link.write(HandCommand::ClearErrors)).await;
        assert!(cleared.is_ok(), "{cleared:?}");
        pass(&mut link, Duration::from_secs(1)).await;
        let stats = link.stats();
        assert!(stats.state_reads > 50, "{stats:?}");
        assert_eq!(stats.timeouts, 0, "{stats:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn an_echo_alone_is_no_hand() {
    let oddity = Oddity {
        echoes: true,
        alone: true,
        ..Oddity::default()
    };
    let mut link = through(oddity, 1);
    assert_eq!(trouble(&link).await, LinkTrouble::NoAnswer { id: 1 });
    pass(&mut link, Duration::from_secs(5)).await;
    assert_eq!(link.stats().state_reads, 0);
}

#[tokio::test(start_paused = true)]
async fn an_adapter_that_refuses_says_so() {
    for (refuses, words) in [
        (b'S', "refused 1000000 bit/s"),
        (b'O', "could not join the bus"),
        (b'T', "stay in the queue"),
    ] {
        let oddity = Oddity {
            refuses: Some(refuses),
            ..Oddity::default()
        };
        let link = through(oddity, 1);
        let told = trouble(&link).await.to_string();
        assert!(told.contains(words), "{told}");
    }
}

/// An error frame of Linux: its class, and the controller's state in byte 1.
fn error_frame(class: u32, state: u8) -> [u8; 16] {
    let mut record = [0; 16];
    record[..4].copy_from_slice(&(0x2000_0000 | class).to_ne_bytes());
    record[4] = 8;
    record[9] = state;
    record
}

#[tokio::test(start_paused = true)]
async fn what_the_controller_says_of_the_bus_is_told() {
    for (class, state, wanted) in [
        (
            0x40,
            0,
            TransportError::BusOff {
                place: "can9".into(),
            },
        ),
        (
            0x04,
            0x20,
            TransportError::ErrorPassive {
                place: "can9".into(),
            },
        ),
    ] {
        let link = connect("can:can9", move |mut far| {
            tokio::spawn(async move {
                let mut asked = [0; 16];
                while far.read_exact(&mut asked).await.is_ok() {
                    let said = far.write_all(&error_frame(class, state)).await;
                    said.unwrap();
                }
            });
        });
        let told = trouble(&link).await;
        assert_eq!(told, LinkTrouble::Transport(wanted));
    }
}

/// A hand whose every short is its clock in milliseconds, and whose replies are late, doubled or lost by chance.
async fn unreliable(clock: Clock, seed: u64, far: Pipe) {
    let mut rng = fastrand::Rng::with_seed(seed);
    let (mut from, to) = tokio::io::split(far);
    let to = Arc::new(tokio::sync::Mutex::new(to));
    let mut asked = [0; 16];
    while from.read_exact(&mut asked).await.is_ok() {
        let id = u32::from_ne_bytes([asked[0], asked[1], asked[2], asked[3]]);
        let (is_write, address) = ((id >> 26) & 7 == 1, (id >> 14) & 0xFFF);
        let mut reply = asked;
        let len = if is_write { 1 } else { asked[8] };
        reply[4] = len;
        let ms = (clock.now().micros() / 1000) as u16;
        for at in 0..usize::from(len) {
            let is_short = (1534..1606).contains(&address);
            let byte = ms.to_le_bytes()[at % 2];
            // Its temperatures and its address are those of a hand.
            reply[8 + at] = match address + u32::try_from(at).unwrap() {
                1618..1624 => 30,
                1700 => 192,
                1703 => 210,
                _ if is_short => byte,
                _ => 0,
            };
        }
        let times = match rng.u16(..1000) {
            0..3 => vec![],
            3..15 => vec![rng.u64(40..900)],
            // A receiver that missed the end of a frame makes the controller send it again at once.
            15..30 => vec![1, rng.u64(1..4)],
            _ => vec![1],
        };
        for time in times {
            let to = Arc::clone(&to);
            tokio::spawn(async move {
                sleep(Duration::from_millis(time)).await;
                let _gone = to.lock().await.write_all(&reply).await;
            });
        }
    }
}

#[tokio::test(start_paused = true)]
async fn no_late_or_doubled_piece_is_taken_for_a_fresh_one() {
    for seed in 0..60 {
        let clock = Clock::start();
        let dial = link::behind(move |_, far| drop(tokio::spawn(unreliable(clock, seed, far))));
        let mut link = link::open(LinkConfig {
            clock,
            ..link::config("can:test", dial)
        });
        let until = Instant::now() + Duration::from_secs(5);
        let mut seen = 0;
        while let Ok(event) = tokio::time::timeout_at(until, link.records.next()).await {
            let Some(Record::Reading { sample, .. }) = event else {
                continue;
            };
            let Some(angle) = sample.angle else { continue };
            let (asked, received) = (ms(angle.asked), ms(angle.received));
            for dof in Dof::ALL {
                let told = u64::from(angle.value[dof].raw().unsigned_abs());
                assert!(
                    (asked..=received).contains(&told),
                    "seed {seed}: {told} in {asked}..={received}"
                );
            }
            seen += 1;
        }
        assert!(seen > 20, "seed {seed}: {seen} {:?}", link.stats());
    }
}

fn ms(at: Moment) -> u64 {
    at.micros() / 1000
}
