//! Who else is on the line: adapters that give back what is sent, and other controllers. On a virtual bus, in virtual time.

use crate::setup::body::Quirks;
use crate::setup::device;
use crate::setup::hand;
use crate::setup::link::{self, Client, ended, pass};
use handscope::codec::can::{read_request, to_record};
use handscope::hand::Setpoints;
use handscope::hand::{
    Angle, Dof, Force, Gesture, GestureRoute, HandCommand, Span, Speed, Target, register,
};
use handscope::link::{LinkStatus, RequestError};
use handscope::record::{Disarmed, Hold, LinkState, SetpointConflict, SetpointRegister};
use handscope::sim::serve::{can, rs485};
use handscope::sim::{Scenario, SharedHand, SimConfig};
use handscope::transport::{Dial, Endpoint, Pipe, pair};
use std::sync::{Arc, Mutex};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::sync::mpsc;
use tokio::time::Duration;

const SOON: Duration = Duration::from_secs(3);
/// Another controller that is not heard of any more is forgotten after five seconds.
const FORGOTTEN: Duration = Duration::from_secs(6);

/// A line with one hand, ourselves, and room for another speaker.
struct Bus {
    hand: SharedHand,
    /// Bytes come in pieces of this length.
    piece: usize,
    echo: bool,
    mute: Arc<Mutex<bool>>,
    others: Mutex<Option<mpsc::Sender<Vec<u8>>>>,
}

impl Bus {
    fn new(piece: usize, echo: bool) -> Arc<Self> {
        Arc::new(Self {
            hand: hand::plain(),
            piece,
            echo,
            mute: Arc::default(),
            others: Mutex::default(),
        })
    }

    /// Another speaker says this, on the line that is open now.
    async fn say(&self, frame: &[u8]) {
        let line = self.others.lock().unwrap().clone().unwrap();
        line.send(frame.to_vec()).await.unwrap();
    }

    fn journal(&self) -> Vec<u16> {
        self.hand.with(|hand, _| {
            let all = hand.journal().iter();
            all.map(|entry| entry.address).collect()
        })
    }
}

/// Everybody hears what everybody says; we hear ourselves only through an adapter that echoes.
struct Line {
    ours: Pipe,
    hand: Pipe,
    others: mpsc::Receiver<Vec<u8>>,
    piece: usize,
    echo: bool,
    mute: Arc<Mutex<bool>>,
}

impl Line {
    async fn run(mut self) {
        let (mut asked, mut answered) = ([0; 512], [0; 512]);
        loop {
            tokio::select! {
                biased;
                read = self.hand.read(&mut answered) => {
                    let Ok(len @ 1..) = read else { return };
                    self.tell_us(&answered[..len]).await;
                }
                read = self.ours.read(&mut asked) => {
                    let Ok(len @ 1..) = read else { return };
                    if self.echo {
                        self.tell_us(&asked[..len]).await;
                    }
                    self.tell_hand(&asked[..len]).await;
                }
                said = self.others.recv() => {
                    let Some(said) = said else { return };
                    self.tell_us(&said).await;
                    self.tell_hand(&said).await;
                }
            }
        }
    }

    async fn tell_us(&mut self, bytes: &[u8]) {
        for piece in bytes.chunks(self.piece) {
            let _gone = self.ours.write_all(piece).await;
            // Each piece is read by itself.
            tokio::task::yield_now().await;
        }
    }

    async fn tell_hand(&mut self, bytes: &[u8]) {
        if !*self.mute.lock().unwrap() {
            let _gone = self.hand.write_all(bytes).await;
        }
    }
}

impl Dial for Bus {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        let (near, ours) = pair();
        let (far, at_hand) = pair();
        let (say, others) = mpsc::channel(64);
        *self.others.lock().unwrap() = Some(say);
        let (hand, quirks) = (self.hand.clone(), Quirks::default());
        match endpoint {
            Endpoint::Rtu(_) => drop(tokio::spawn(device::modbus_rtu(hand, at_hand, quirks, 1))),
            Endpoint::Tcp { .. } => {
                drop(tokio::spawn(device::modbus_tcp(hand, at_hand, quirks, 1)));
            }
            Endpoint::Can { .. } => drop(tokio::spawn(can::serve(hand, at_hand))),
            _ => drop(tokio::spawn(rs485::serve(hand, at_hand))),
        }
        let line = Line {
            ours,
            hand: far,
            others,
            piece: self.piece,
            echo: self.echo,
            mute: Arc::clone(&self.mute),
        };
        tokio::spawn(line.run());
        link::opened(near)
    }
}

fn open(bus: &Arc<Bus>, endpoint: &str) -> Client {
    link::connect(endpoint, Arc::clone(bus) as Arc<dyn Dial>)
}

async fn until(link: &mut Client, wanted: impl Fn(&LinkStatus) -> bool) -> LinkStatus {
    link::until(link, SOON, wanted).await
}

async fn arm(link: &mut Client) {
    until(link, |status| status.state.is_live()).await;
    pass(link, Duration::from_millis(200)).await;
    link.arm(link::gentle());
    until(link, |status| status.armed.is_some()).await;
}

#[tokio::test(start_paused = true)]
async fn an_adapter_that_echoes_is_recognised_and_its_echoes_are_left_out_however_they_are_cut() {
    for wire in ["rs485:test", "rtu:test"] {
        for (echo, piece) in [(true, 1), (true, 3), (true, 7), (true, 512), (false, 5)] {
            let bus = Bus::new(piece, echo);
            let mut link = open(&bus, wire);
            arm(&mut link).await;
            let mut setpoints = Setpoints::none(link.status().armed.unwrap());
            setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(500)));
            link.set(&setpoints);
            // Over RTU this is function 06, whose reply is like its request.
            let cleared = ended(link.write(HandCommand::ClearErrors)).await;
            assert_eq!(cleared, Ok(()), "{wire} {piece}");
            pass(&mut link, Duration::from_secs(2)).await;
            let (status, stats) = (link.status(), link.stats());
            assert_eq!(status.echoes, echo, "{wire} {piece}");
            assert_eq!(
                (status.state, status.other_controller),
                (LinkState::Armed, false)
            );
            let bad = [
                stats.timeouts,
                stats.checksum_errors,
                stats.resyncs,
                stats.foreign_replies,
                stats.foreign_requests,
                stats.reconnects,
            ];
            assert_eq!(
                bad, [0; 6],
                "{wire} echo {echo} in pieces of {piece}: {stats:?}"
            );
            let clears = bus.journal().iter().filter(|at| **at == 1004).count();
            assert_eq!(clears, 1);
        }
    }
}

#[tokio::test(start_paused = true)]
async fn an_echo_is_never_taken_for_the_hands_acknowledgement() {
    for wire in ["rs485:test", "rtu:test"] {
        let bus = Bus::new(4, true);
        let mut link = open(&bus, wire);
        until(&mut link, |status| status.echoes).await;
        *bus.mute.lock().unwrap() = true;
        let cleared = ended(link.write(HandCommand::ClearErrors)).await;
        assert!(
            matches!(
                cleared,
                Err(RequestError::Timeout { .. } | RequestError::LinkLost)
            ),
            "{wire}: {cleared:?}"
        );
        assert!(!bus.journal().contains(&1004));
    }
}

/// What another controller may say on each wire.
fn request_of_another(wire: &str) -> Vec<u8> {
    match wire {
        // Angles of hand 1: manual 2.2.1, sum reckoned by hand.
        "rs485:test" => vec![0xEB, 0x90, 1, 4, 0x11, 0x0A, 6, 12, 0x32],
        "rtu:test" => {
            let mut frame = vec![1, 3, 6, 0x0A, 0, 6];
            frame.extend(device::crc(&frame));
            frame
        }
        _ => {
            let span = Span::new(register::FORCE_ACT.address, 8);
            to_record(&read_request(1, span).unwrap()).to_vec()
        }
    }
}

async fn another_talks(link: &mut Client, bus: &Bus, frame: &[u8], times: u32) {
    for _ in 0..times {
        bus.say(frame).await;
        pass(link, Duration::from_millis(50)).await;
    }
}

#[tokio::test(start_paused = true)]
async fn another_controller_is_noticed_and_disarms_once_and_arming_again_is_the_persons_word() {
    for wire in ["rs485:test", "rtu:test", "can:test"] {
        let bus = Bus::new(512, false);
        let mut link = open(&bus, wire);
        let frame = request_of_another(wire);
        arm(&mut link).await;
        another_talks(&mut link, &bus, &frame, 10).await;
        let status = link.status();
        assert!(status.other_controller, "{wire}: {:?}", link.stats());
        assert_eq!(
            (status.armed, status.disarmed),
            (None, Some(Disarmed::OtherController))
        );
        assert!((3..=10).contains(&link.stats().foreign_requests), "{wire}");
        arm(&mut link).await;
        another_talks(&mut link, &bus, &frame, 40).await;
        let status = link.status();
        assert!(
            status.other_controller && status.armed.is_some(),
            "{wire}: {status:?}"
        );
        pass(&mut link, FORGOTTEN).await;
        let status = link.status();
        assert!(
            !status.other_controller && status.armed.is_some(),
            "{wire}: {status:?}"
        );
        another_talks(&mut link, &bus, &frame, 10).await;
        assert_eq!(
            link.status().disarmed,
            Some(Disarmed::OtherController),
            "{wire}: again"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn setpoints_that_another_client_changes_are_noticed_over_tcp_too() {
    for wire in ["tcp:127.0.0.1:6000", "rs485:test"] {
        let bus = Bus::new(512, false);
        let mut link = open(&bus, wire);
        arm(&mut link).await;
        pass(&mut link, SOON).await;
        assert!(!link.status().other_controller);
        bus.hand
            .with(|hand, now| {
                hand.write(register::SPEED_SET.address, &[7, 0].repeat(6), now)
                    .map(drop)
            })
            .unwrap();
        let status = until(&mut link, |status| status.other_controller).await;
        assert_eq!(
            (status.armed, status.disarmed),
            (None, Some(Disarmed::OtherController))
        );
        assert_eq!(link.stats().foreign_requests, 1);
    }
}

#[tokio::test(start_paused = true)]
async fn what_we_do_ourselves_is_no_other_controller() {
    for wire in ["tcp:127.0.0.1:6000", "rs485:test", "rtu:test", "can:test"] {
        let bus = Bus::new(512, false);
        let mut link = open(&bus, wire);
        arm(&mut link).await;
        let epoch = link.status().armed.unwrap();
        for step in 0..200i16 {
            let mut setpoints = Setpoints::none(epoch);
            setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(1000 - 4 * step)));
            setpoints.force[Dof::Index] = Some(Force::nearest(300 + step));
            link.set(&setpoints);
            pass(&mut link, Duration::from_millis(60)).await;
        }
        let gesture = HandCommand::Gesture(Gesture::nearest(3), GestureRoute::default());
        ended(link.write_as(link.lease(), gesture)).await.unwrap();
        pass(&mut link, FORGOTTEN).await;
        let status = link.status();
        assert!(
            !status.other_controller && status.armed.is_some(),
            "{wire}: {status:?}"
        );
        assert_eq!(link.stats().foreign_requests, 0, "{wire}");
    }
}

/// A hand on Modbus TCP that several connections reach; none hears the others.
struct OnTcp {
    hand: SharedHand,
}

impl OnTcp {
    fn new() -> Self {
        let hand = hand::begin(hand::free(SimConfig::default()));
        Self { hand }
    }

    async fn armed(&self) -> Client {
        let mut link = link::connect("tcp:127.0.0.1:6000", link::to_hand(self.hand.clone()));
        arm(&mut link).await;
        link
    }

    /// Another program writes these elements.
    fn write(&self, at: u16, values: &[i16]) {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let written = self
            .hand
            .with(|hand, now| hand.write(at, &bytes, now).map(drop));
        written.unwrap();
    }
}

fn move_to(link: &Client, angle: i16) {
    let Some(epoch) = link.status().armed else {
        return;
    };
    let mut setpoints = Setpoints::none(epoch);
    for (_, target) in setpoints.angle.iter_mut() {
        *target = Some(Target::Go(Angle::nearest(angle)));
    }
    link.set(&setpoints);
}

fn conflict(link: &Client) -> Option<SetpointConflict> {
    let status = link.status();
    assert_eq!(
        status.disarmed,
        Some(Disarmed::OtherController),
        "{status:?}"
    );
    status.foreign_setpoint
}

/// What the other writes is overwritten within 10 ms: it is seen only where it is looked for right before that.
#[tokio::test(start_paused = true)]
async fn another_program_that_writes_into_a_stream_of_setpoints_is_noticed_over_tcp() {
    for seed in 0..20 {
        let mut chance = fastrand::Rng::with_seed(seed);
        let at = OnTcp::new();
        let mut link = at.armed().await;
        let mut writes = 0;
        let mut next = 100 + chance.i16(0..20);
        for step in 0..450 {
            let Some(epoch) = link.status().armed else {
                break;
            };
            let mut setpoints = Setpoints::none(epoch);
            setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(1000 - step)));
            link.set(&setpoints);
            if step == next {
                pass(&mut link, Duration::from_millis(chance.u64(..10))).await;
                at.write(1486, &[913; 6]);
                writes += 1;
                next += 15 + chance.i16(0..10);
            }
            pass(&mut link, Duration::from_millis(10)).await;
        }
        let foreign = conflict(&link).unwrap();
        assert_eq!(
            (foreign.register, foreign.holds),
            (SetpointRegister::AngleSet, Some(913))
        );
        assert!(writes <= 12, "seed {seed}: after {writes} writes");
    }
}

/// A joint that no round writes keeps what the other wrote.
#[tokio::test(start_paused = true)]
async fn another_programs_single_write_to_a_joint_that_a_stream_leaves_alone_is_noticed_over_tcp() {
    for (moved, theirs) in [
        (Dof::Index, Dof::Little),
        (Dof::Little, Dof::ThumbRotate),
        (Dof::ThumbBend, Dof::Index),
    ] {
        let at = OnTcp::new();
        let mut link = at.armed().await;
        for step in 0..150 {
            let Some(epoch) = link.status().armed else {
                break;
            };
            let mut setpoints = Setpoints::none(epoch);
            for dof in [moved, Dof::Ring] {
                setpoints.angle[dof] = Some(Target::Go(Angle::nearest(1000 - step)));
            }
            link.set(&setpoints);
            if step == 100 {
                at.write(1486 + 2 * theirs as u16, &[913]);
            }
            pass(&mut link, Duration::from_millis(10)).await;
        }
        let foreign = conflict(&link).unwrap();
        assert_eq!(foreign.dof, theirs);
        assert_eq!(
            (foreign.register, foreign.holds),
            (SetpointRegister::AngleSet, Some(913))
        );
    }
}

#[tokio::test(start_paused = true)]
async fn another_programs_write_is_noticed_within_a_second_while_we_move_the_hand_over_tcp() {
    let mut chance = fastrand::Rng::with_seed(26);
    let (angle_set, force_set, speed_set) = (1486, 1498, 1522);
    for nth in 0..56 {
        let at = OnTcp::new();
        let mut link = at.armed().await;
        // Poses, each 700 ms, and the foreign write at any moment between.
        let poses = 1 + chance.u64(..3);
        for pose in 0..poses {
            move_to(&link, 900 - 100 * i16::try_from(pose).unwrap());
            pass(&mut link, Duration::from_millis(700)).await;
        }
        move_to(&link, 300);
        pass(&mut link, Duration::from_millis(chance.u64(20..650))).await;
        let (register, place, value) = match nth {
            0..40 => (
                SetpointRegister::AngleSet,
                angle_set,
                chance.i16(400..=1000),
            ),
            40..48 => (SetpointRegister::ForceSet, force_set, chance.i16(600..3000)),
            _ => (SetpointRegister::SpeedSet, speed_set, chance.i16(300..1000)),
        };
        at.write(place, &[value; 6]);
        let mut waited = 0;
        while link.status().armed.is_some() {
            pass(&mut link, Duration::from_millis(50)).await;
            waited += 50;
            assert!(
                waited <= 1000,
                "{nth}: {register:?} {value} {:?}",
                link.status()
            );
        }
        let seen = conflict(&link).unwrap();
        assert_eq!((seen.register, seen.holds), (register, Some(value)));
        let ours = [
            Some(300),
            Some(Force::GENTLE.get()),
            Some(Speed::GENTLE.get()),
        ];
        assert!(ours.contains(&seen.wrote), "{seen:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn two_programs_that_stream_to_one_tcp_hand_do_not_fight_longer_than_two_seconds() {
    for seed in 0..20 {
        let mut chance = fastrand::Rng::with_seed(seed);
        let at = OnTcp::new();
        let (mut one, mut two) = (at.armed().await, at.armed().await);
        let both = |one: &Client, two: &Client| {
            one.status().armed.is_some() && two.status().armed.is_some()
        };
        let mut fought = 0;
        for step in 0..i16::MAX {
            move_to(&one, 1000 - (10 * step) % 900);
            pass(&mut one, Duration::from_millis(chance.u64(1..20))).await;
            move_to(&two, 100 + (10 * step) % 900);
            let rest = chance.u64(1..20);
            pass(&mut two, Duration::from_millis(rest)).await;
            fought += 20;
            if !both(&one, &two) {
                break;
            }
            assert!(fought <= 2000, "{seed}: {:?}", one.status());
        }
        let loser = [&one, &two]
            .into_iter()
            .find(|link| link.status().armed.is_none());
        let seen = conflict(loser.unwrap()).unwrap();
        assert_eq!(seen.register, SetpointRegister::AngleSet);
    }
}

/// The round that sends a joint off writes its speed before its angle: it is no stream, so it is read back at once.
#[tokio::test(start_paused = true)]
async fn another_programs_target_right_behind_ours_is_noticed_within_half_a_second_over_tcp() {
    let targets = [(300, 600), (300, 100), (1000, 500)];
    for (ours, theirs) in targets {
        for behind in [20, 30, 50, 80, 120, 250] {
            for moved_before in [false, true] {
                let at = OnTcp::new();
                let mut link = at.armed().await;
                if moved_before {
                    move_to(&link, 900);
                    pass(&mut link, Duration::from_millis(700)).await;
                }
                let mut setpoints = Setpoints::none(link.status().armed.unwrap());
                setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(ours)));
                setpoints.speed[Dof::Index] = Some(Speed::nearest(300));
                link.set(&setpoints);
                pass(&mut link, Duration::from_millis(behind)).await;
                at.write(1492, &[theirs]);
                let mut waited = 0;
                while link.status().armed.is_some() {
                    pass(&mut link, Duration::from_millis(10)).await;
                    waited += 10;
                    let status = link.status();
                    assert!(
                        waited <= 500,
                        "{ours}, {theirs}, {behind} ms behind: {status:?}"
                    );
                }
                assert_eq!(conflict(&link).unwrap().holds, Some(theirs));
            }
        }
    }
}

/// Another's target that comes before ours is read back looks like a hand that limits what it takes, so it is not called another
/// controller. The joint went where the hand holds it: a stop leaves it there.
#[tokio::test(start_paused = true)]
async fn a_stop_moves_no_joint_that_another_sent_elsewhere_unnoticed() {
    for wire in ["rs485:test", "rtu:test", "tcp:127.0.0.1:6000", "can:test"] {
        let hand = hand::shared(SimConfig {
            scenario: Scenario::Free,
            ..SimConfig::default()
        });
        let mut link = link::connect(wire, link::to_hand(hand.clone()));
        arm(&mut link).await;
        let mut setpoints = Setpoints::none(link.status().armed.unwrap());
        setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(200)));
        setpoints.speed[Dof::Index] = Some(Speed::MAX);
        link.set(&setpoints);
        pass(&mut link, Duration::from_millis(30)).await;
        let foreign = 500_i16.to_le_bytes();
        hand.with(|hand, now| hand.write(1492, &foreign, now))
            .unwrap();
        let index = || hand::true_angle(&hand, Dof::Index);
        pass(&mut link, Duration::from_secs(3)).await;
        let before = index();
        assert!((before - 500.0).abs() < 5.0, "{wire}: {before}");
        link.stop();
        for _ in 0..100 {
            pass(&mut link, Duration::from_millis(10)).await;
            assert!((index() - before).abs() < 5.0, "{wire}: {}", index());
        }
        let hold = link.status().hold;
        assert!(matches!(hold, Hold::Confirmed { .. }), "{wire}: {hold:?}");
    }
}
