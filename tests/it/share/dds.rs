//! A hand on DDS: told and followed by Unitree's own stack, and by nobody unless a person wants it.

use crate::setup::busy::unless_busy;
use crate::setup::hand;
use crate::setup::link::{config, to_hand};
use crate::setup::process::{Running, handscope, listen, start};
use crate::setup::skipped::skipped;
use handscope::hand::kinematics::Side;
use handscope::link::{self, LinkHandle};
use handscope::record::file::format::cdr;
use handscope::record::file::format::message::{GripMessage, TfMessage};
use handscope::share::dds::DdsPublisher;
use handscope::transport::dds::{DdsError, DdsMessage, DdsNode, DdsPlace, DdsTopic};
use nix::sys::signal::Signal;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fs;
use std::io::{PipeWriter, Write as _};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tokio::runtime::Handle;
use tokio::sync::mpsc;
use tokio::time::{sleep, timeout};

/// Far more than anything takes here.
const PATIENCE: Duration = Duration::from_secs(20);
/// Commands of a round, and how many of them, and of the states meanwhile, must arrive.
const COMMANDS: u64 = 500;
const ARRIVE: f64 = 0.99;

/// At the loopback, in a domain that no other test uses.
fn place(domain: u16) -> DdsPlace {
    DdsPlace {
        interface: "127.0.0.1".into(),
        domain,
    }
}

fn states(node: &DdsNode) -> mpsc::Receiver<DdsMessage> {
    let topic = DdsTopic {
        name: "rt/inspire_hand/state/l".into(),
        type_name: "inspire::inspire_hand_state".into(),
    };
    node.reader(&topic, 64)
}

type Lists = (
    Vec<i16>,
    Vec<i16>,
    Vec<i16>,
    Vec<i16>,
    Vec<u8>,
    Vec<u8>,
    Vec<u8>,
);

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn states_are_told_while_the_hand_answers_and_not_a_moment_longer() {
    let (tells, listens) = (DdsNode::open(&place(41)), DdsNode::open(&place(41)));
    let mut heard = states(&listens.unwrap());
    let hand = hand::plain();
    let (link, _records): (LinkHandle, _) = link::open(
        config("tcp:127.0.0.1:1", to_hand(hand.clone())),
        &Handle::current(),
    );
    let publisher = DdsPublisher::open(&tells.unwrap(), &link, Side::Left);
    let message = timeout(PATIENCE, heard.recv()).await.unwrap().unwrap();
    let (_, angle, _, _, err, _, temperature): Lists = cdr::decode(&message.bytes).unwrap();
    assert_eq!((angle, err), (vec![1000; 6], vec![0; 6]));
    assert!(
        temperature.iter().all(|degrees| *degrees > 10),
        "{temperature:?}"
    );
    for _ in 0..50 {
        timeout(PATIENCE, heard.recv()).await.unwrap().unwrap();
    }
    // It may only say what it has read, and the link is what reads.
    let told = publisher.counts();
    assert!(told.states >= 50 && told.lost == 0, "{told:?}");
    drop(link);
    sleep(Duration::from_millis(500)).await;
    while heard.try_recv().is_ok() {}
    let more = timeout(Duration::from_millis(700), heard.recv()).await;
    assert!(more.is_err(), "{more:?}");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn the_grip_is_told_as_a_recording_has_it() {
    let (tells, listens) = (DdsNode::open(&place(57)), DdsNode::open(&place(57)));
    let topic = DdsTopic {
        name: "rt/handscope/grip".into(),
        type_name: "handscope_msgs::msg::dds_::Grip_".into(),
    };
    let mut heard = listens.unwrap().reader(&topic, 64);
    let (link, _records): (LinkHandle, _) = link::open(
        config("tcp:127.0.0.1:1", to_hand(hand::plain())),
        &Handle::current(),
    );
    let publisher = DdsPublisher::open(&tells.unwrap(), &link, Side::Left);
    let first = timeout(PATIENCE, async {
        loop {
            let message = heard.recv().await.unwrap();
            let grip: GripMessage = cdr::decode(&message.bytes).unwrap();
            if grip.state != "unknown" {
                return grip;
            }
        }
    });
    let grip = first.await.unwrap();
    assert_eq!(grip.finger_states.len(), 5);
    assert!(
        grip.at.nanos() >= grip.since.nanos() && grip.asked.nanos() > 0,
        "{grip:?}"
    );
    assert_eq!(publisher.counts().lost, 0);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn the_model_is_there_for_late_readers_and_its_frames_come_with_each_reading() {
    let (tells, listens) = (DdsNode::open(&place(58)), DdsNode::open(&place(58)));
    let listens = listens.unwrap();
    let topic = |name: &str, type_name: &str| DdsTopic {
        name: name.into(),
        type_name: type_name.into(),
    };
    let frames = "tf2_msgs::msg::dds_::TFMessage_";
    let (link, _records): (LinkHandle, _) = link::open(
        config("tcp:127.0.0.1:1", to_hand(hand::plain())),
        &Handle::current(),
    );
    let _publisher = DdsPublisher::open(&tells.unwrap(), &link, Side::Left);
    let mut moving = listens.reader(&topic("rt/tf", frames), 64);
    let mut stamps = Vec::new();
    while stamps.len() < 20 {
        let message = timeout(PATIENCE, moving.recv()).await.unwrap().unwrap();
        let message: TfMessage = cdr::decode(&message.bytes).unwrap();
        assert_eq!(message.transforms.len(), 12);
        stamps.push(message.transforms[0].header.stamp.nanos());
    }
    // A hundred a second, and not the ten of a file.
    let took = Duration::from_nanos(stamps[19] - stamps[0]);
    assert!(took < Duration::from_secs(1), "{took:?}");
    // One of other authors that asks long after they were sent.
    let theirs = rustdds::DomainParticipantBuilder::new(58)
        .with_only_networks([std::net::Ipv4Addr::LOCALHOST])
        .build()
        .unwrap();
    let fixed: TfMessage = kept(&theirs, "rt/tf_static", frames).await;
    assert_eq!(fixed.transforms.len(), 5);
    let string = "std_msgs::msg::dds_::String_";
    let model: String = kept(&theirs, "rt/robot_description", string).await;
    let message = timeout(PATIENCE, moving.recv()).await.unwrap().unwrap();
    let moving: TfMessage = cdr::decode(&message.bytes).unwrap();
    for frame in moving.transforms.iter().chain(&fixed.transforms) {
        for name in [&frame.child_frame_id, &frame.header.frame_id] {
            assert!(model.contains(&format!("<link name=\"{name}\"")), "{name}");
        }
    }
}

/// The message of a topic that was sent before this asks for it.
async fn kept<T: DeserializeOwned + 'static>(
    by: &rustdds::DomainParticipant,
    topic: &str,
    type_name: &str,
) -> T {
    use futures::StreamExt as _;
    use rustdds::policy::{Durability, History, Reliability};
    let quality = rustdds::QosPolicyBuilder::new()
        .durability(Durability::TransientLocal)
        .history(History::KeepLast { depth: 1 })
        .reliability(Reliability::Reliable {
            max_blocking_time: rustdds::Duration::ZERO,
        })
        .build();
    let kind = rustdds::TopicKind::NoKey;
    let topic = by
        .create_topic(topic.into(), type_name.into(), &quality, kind)
        .unwrap();
    let reads = by.create_subscriber(&quality).unwrap();
    let reader: rustdds::no_key::DataReader<T, rustdds::CDRDeserializerAdapter<T>> =
        reads.create_datareader_no_key(&topic, None).unwrap();
    let mut samples = reader.async_sample_stream();
    let first = timeout(PATIENCE, samples.next()).await.unwrap().unwrap();
    first.unwrap().into_value()
}

#[test]
fn an_interface_that_is_not_there_is_named() {
    unless_busy(|| {
        for interface in ["nowhere0", "203.0.113.7", "::1"] {
            let place = DdsPlace {
                interface: interface.into(),
                domain: 42,
            };
            let error = DdsNode::open(&place).unwrap_err();
            assert!(matches!(error, DdsError::NoInterface { .. }), "{error}");
            assert!(error.to_string().contains(interface), "{error}");
        }
        let mut named = place(42);
        named.interface = "lo".into();
        assert!(DdsNode::open(&named).unwrap().address().is_loopback());
    });
}

/// Ports of DDS in a domain (RTPS 9.6.2.3) that somebody listens at.
fn listened(domain: u16) -> usize {
    let first = 7400 + 250 * domain;
    let ports = (first..first + 30).filter(|port| UdpSocket::bind(("0.0.0.0", *port)).is_err());
    ports.count()
}

#[test]
fn nobody_listens_before_it_is_opened_or_after_it_is_closed() {
    unless_busy(|| {
        assert_eq!(listened(43), 0);
        let node = DdsNode::open(&place(43)).unwrap();
        assert!(listened(43) > 0);
        drop(node);
        let patience = Instant::now() + PATIENCE;
        while listened(43) > 0 {
            assert!(Instant::now() < patience, "somebody listens");
            std::thread::sleep(Duration::from_millis(10));
        }
    });
}

/// Where a process listens for UDP, as `ADDRESS:PORT` in hex of the machine's byte order.
fn udp_places(id: u32) -> Vec<String> {
    let table = fs::read_to_string(format!("/proc/{id}/net/udp")).unwrap();
    let open = fs::read_dir(format!("/proc/{id}/fd")).unwrap();
    let open = open.filter_map(|entry| fs::read_link(entry.ok()?.path()).ok());
    let open: Vec<String> = open
        .filter_map(|link| Some(link.to_str()?.to_owned()))
        .collect();
    let place = |line: &str| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let name = format!("socket:[{}]", fields[9]);
        open.contains(&name).then(|| fields[1].to_owned())
    };
    table.lines().skip(1).filter_map(place).collect()
}

#[test]
fn it_listens_at_its_interface_and_nowhere_else() {
    unless_busy(|| {
        if !Path::new("/proc/self/net/udp").exists() {
            return skipped("sockets of a process", "this system does not list them");
        }
        let mut running = start(&["share", "--hand", "sim:", "--dds", "--domain", "47"]);
        running.until(|line| line == "ready dds 127.0.0.1");
        let places = udp_places(running.id());
        assert_eq!(places.len(), 3, "{places:?}");
        let own = u32::from_ne_bytes([127, 0, 0, 1]);
        let group = u32::from_ne_bytes([239, 255, 0, 1]);
        for place in &places {
            let (address, _) = place.split_once(':').unwrap();
            let address = u32::from_str_radix(address, 16).unwrap();
            assert!([own, group].contains(&address), "{places:?}");
        }
    });
}

/// Resident memory of a process in MB.
fn resident_mb(id: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap();
    let line = status
        .lines()
        .find(|line| line.starts_with("VmRSS:"))
        .unwrap();
    let kilobytes = line.split_whitespace().nth(1).unwrap();
    kilobytes.parse::<u64>().unwrap() / 1024
}

/// A heartbeat of 2^40 messages, in the name of a participant.
fn heartbeat(prefix: &[u8], writer: [u8; 4]) -> Vec<u8> {
    let range = [[0_u32, 1], [256, 0]].concat();
    let range = range.into_iter().flat_map(u32::to_le_bytes).collect();
    let parts: [Vec<u8>; 6] = [
        b"RTPS\x02\x02\x00\x00".to_vec(),
        prefix.to_vec(),
        vec![7, 1, 28, 0],
        [[0; 4], writer].concat(),
        range,
        vec![1, 0, 0, 0],
    ];
    parts.concat()
}

/// Datagrams that others sent, each changed at some places and in the name of this participant.
fn forged(prefix: &[u8], many: usize) -> impl Iterator<Item = Vec<u8>> {
    let lines = include_str!("../../interop/rtps_packets.txt").lines();
    let byte = |two: &[u8]| u8::from_str_radix(str::from_utf8(two).unwrap(), 16).unwrap();
    let packet = |line: &str| -> Vec<u8> { line.as_bytes().chunks(2).map(byte).collect() };
    let packets: Vec<Vec<u8>> = lines
        .filter(|line| !line.starts_with('#'))
        .map(packet)
        .collect();
    let mut random = fastrand::Rng::with_seed(52);
    (0..many).map(move |_| {
        let mut packet = packets[random.usize(..packets.len())].clone();
        packet[8..20].copy_from_slice(prefix);
        for _ in 0..random.usize(1..4) {
            let at = random.usize(20..packet.len() - 4);
            let value = [0, 1, u32::MAX, 1 << 31, 1 << 8, random.u32(..)][random.usize(..6)];
            packet[at..at + 4].copy_from_slice(&value.to_le_bytes());
        }
        packet
    })
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn forged_words_take_no_memory_and_the_program_ends_when_it_is_told_to() {
    if !Path::new("/proc/self/status").exists() {
        return skipped("memory of a process", "this system does not tell it");
    }
    let mut running = start(&[
        "share", "--hand", "sim:", "--dds", "--domain", "46", "--side", "left",
    ]);
    running.until(|line| line == "ready dds 127.0.0.1");
    let known = DdsNode::open(&place(46)).unwrap();
    let mut heard = states(&known);
    timeout(PATIENCE, heard.recv()).await.unwrap().unwrap();
    // What it writes tells how it is called.
    let topic = DdsTopic {
        name: "rt/own".into(),
        type_name: "t::T".into(),
    };
    let mut own = known.reader(&topic, 1);
    let writer = known.writer(&topic);
    assert!(writer.send(vec![0, 1, 0, 0]));
    let name = own.recv().await.unwrap().from.0;
    let prefix = &name[..12];
    let before = resident_mb(running.id());
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let first = 7400 + 250 * 46;
    let send = |packet: &[u8]| {
        for port in [first + 10, first + 11, first + 12, first + 13] {
            // Nobody may listen at some of them.
            let _sent = socket.send_to(packet, ("127.0.0.1", port));
        }
    };
    for writer in [
        [0, 0, 3, 0xc2],
        [0, 0, 4, 0xc2],
        [0, 2, 0, 0xc2],
        [0, 0, 1, 3],
    ] {
        let packet = heartbeat(prefix, writer);
        assert_eq!(packet.len(), 52);
        send(&packet);
    }
    for (nth, packet) in forged(prefix, 20_000).enumerate() {
        send(&packet);
        if nth % 50 == 0 {
            sleep(Duration::from_millis(1)).await;
        }
    }
    sleep(Duration::from_secs(2)).await;
    let after = resident_mb(running.id());
    println!("{before} MB before, {after} MB after");
    assert!(after < before + 60, "{before} MB before, {after} MB after");
    // It is still heard by one that comes new.
    let mut new = states(&DdsNode::open(&place(46)).unwrap());
    timeout(PATIENCE, new.recv()).await.unwrap().unwrap();
    running.signal(Signal::SIGINT);
    let asked = Instant::now();
    running.end().ok();
    // A second, and what a busy machine adds.
    assert!(
        asked.elapsed() < Duration::from_secs(4),
        "{:?}",
        asked.elapsed()
    );
}

/// The same, read and written by DDS of other authors.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn dds_by_other_authors_hears_ours_and_is_heard() {
    use futures::StreamExt as _;
    use rustdds::no_key::{DataReader, DataWriter};
    use rustdds::policy::{Durability, History, Reliability};
    use rustdds::{CDRDeserializerAdapter, CDRSerializerAdapter, TopicKind};
    let ours = DdsNode::open(&place(48)).unwrap();
    let theirs = rustdds::DomainParticipantBuilder::new(48)
        .with_only_networks([std::net::Ipv4Addr::LOCALHOST])
        .build()
        .unwrap();
    let qos = |durability| {
        rustdds::QosPolicyBuilder::new()
            .durability(durability)
            .history(History::KeepLast { depth: 100 })
            .reliability(Reliability::Reliable {
                max_blocking_time: rustdds::Duration::ZERO,
            })
            .build()
    };
    let volatile = qos(Durability::Volatile);
    let there = |name: &str, qos| {
        let topic = theirs.create_topic(name.into(), "t::T".into(), qos, TopicKind::NoKey);
        topic.unwrap()
    };
    let reads = theirs.create_subscriber(&volatile).unwrap();
    let writes = theirs.create_publisher(&volatile).unwrap();
    let here = |name: &str| DdsTopic {
        name: name.into(),
        type_name: "t::T".into(),
    };
    let kept = ours.lasting_writer(&here("kept"));
    assert!(kept.send([[0, 1, 0, 0], 5_u32.to_le_bytes()].concat()));
    let lasting = qos(Durability::TransientLocal);
    let topic = there("kept", &lasting);
    let late: DataReader<u32, CDRDeserializerAdapter<u32>> =
        reads.create_datareader_no_key(&topic, None).unwrap();
    let topic = there("back", &volatile);
    let writer: DataWriter<u32, CDRSerializerAdapter<u32>> =
        writes.create_datawriter_no_key(&topic, None).unwrap();
    let mut back = ours.reader(&here("back"), 64);
    let mut late = late.async_sample_stream();
    let first = timeout(PATIENCE, late.next()).await.unwrap().unwrap();
    assert_eq!(first.unwrap().into_value(), 5);
    let echo = async {
        let mut number = 0;
        loop {
            writer.write(number, None).unwrap();
            number += 1;
            sleep(Duration::from_millis(10)).await;
        }
    };
    let heard = async {
        let mut all = Vec::new();
        while all.len() < 100 {
            let bytes = back.recv().await.unwrap().bytes;
            all.push(u32::from_le_bytes(bytes[4..8].try_into().unwrap()));
        }
        all
    };
    let all = tokio::select! {
        all = timeout(PATIENCE, heard) => all.unwrap(),
        () = echo => unreachable!(),
    };
    let expected: Vec<u32> = (all[0]..all[0] + 100).collect();
    assert_eq!(all, expected);
}

#[test]
fn it_is_off_unless_a_person_wants_it() {
    unless_busy(|| {
        if !Path::new("/proc/self/net/udp").exists() {
            return skipped("sockets of a process", "this system does not list them");
        }
        let dds: &[&str] = &["--dds", "--domain", "44"];
        for (words, ready) in [
            (&["share", "--tcp", "127.0.0.1:0"][..], "ready tcp "),
            (&["follow", "--tcp", "127.0.0.1:0"], "ready tcp "),
        ] {
            let mut running = start(&[words, &["--hand", "sim:"]].concat());
            assert!(running.line().starts_with(ready));
            assert_eq!(udp_places(running.id()), [""; 0], "{words:?}");
        }
        for words in [
            &["share"][..],
            &["share", "--tcp", "127.0.0.1:0"],
            &["follow"],
        ] {
            let mut running = start(&[words, &["--hand", "sim:"], dds].concat());
            running.until(|line| line == "ready dds 127.0.0.1");
            assert!(!udp_places(running.id()).is_empty(), "{words:?}");
            running.signal(Signal::SIGINT);
            running.end().ok();
        }
    });
}

/// Where Unitree's stack and our program meet: a network of their own if there can be one.
struct Meeting {
    _holder: Option<(Running, PipeWriter)>,
    enter: Vec<String>,
    python: String,
}

/// Brings the loopback up, and stays.
const HOLD: &str = "
import fcntl, socket, struct, sys
fcntl.ioctl(socket.socket(), 0x8914, struct.pack('16sh14x', b'lo', 0x49))
print('ready', flush=True)
sys.stdin.read()
";

impl Meeting {
    /// `None` if this machine has no CycloneDDS 0.10.2 for Python.
    fn new() -> Option<Self> {
        let own = std::env::var("HANDSCOPE_DDS_PYTHON").ok();
        let mut pythons = own
            .into_iter()
            .chain(["python3.10", "python3"].map(String::from));
        let python = pythons.find(|python| {
            let asked = Command::new(python)
                .args(["-c", "import cyclonedds.domain"])
                .stderr(Stdio::null())
                .status();
            asked.is_ok_and(|status| status.success())
        })?;
        let (kept, open) = std::io::pipe().unwrap();
        let mut command = Command::new("unshare");
        command.args(["-rn", &python, "-c", HOLD]).stdin(kept);
        let asked = Command::new("unshare").args(["-rn", "true"]).status();
        if !asked.is_ok_and(|status| status.success()) {
            return Some(Self {
                _holder: None,
                enter: Vec::new(),
                python,
            });
        }
        let mut holder = listen(command);
        assert_eq!(holder.line(), "ready");
        let target = format!("--target={}", holder.id());
        let enter = ["nsenter", &target, "-U", "-n", "--preserve-credentials"];
        Some(Self {
            enter: enter.map(String::from).to_vec(),
            _holder: Some((holder, open)),
            python,
        })
    }

    fn command(&self, words: &[&str]) -> Command {
        let own = self.enter.iter().map(String::as_str);
        let mut all = own.chain(words.iter().copied());
        let mut command = Command::new(all.next().unwrap());
        command.args(all).stdin(Stdio::null());
        command
    }

    /// Unitree's end, for so many commands a round and so many rounds.
    fn unitree(&self, commands: u64, rounds: u64) -> Running {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/interop/unitree_dds.py");
        let (commands, rounds) = (commands.to_string(), rounds.to_string());
        let words = ["127.0.0.1", "45", "r", &commands, &rounds];
        listen(self.command(&[&[self.python.as_str(), script], &words[..]].concat()))
    }

    /// A program of ROS 2.
    fn ros(&self) -> Running {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/interop/ros_dds.py");
        listen(self.command(&[self.python.as_str(), script, "127.0.0.1", "45", "right"]))
    }

    /// Our end, and where a person presses Enter.
    fn follow(&self) -> (Running, PipeWriter) {
        let program = handscope().get_program().to_str().unwrap().to_owned();
        let words = ["follow", "--hand", "sim:?scenario=free", "--arm", "--json"];
        let dds = ["--dds", "--domain", "45", "--consent", "stdin"];
        let mut command = self.command(&[&[program.as_str()], &words[..], &dds].concat());
        let (input, person) = std::io::pipe().unwrap();
        command.stdin(input);
        let mut running = listen(command);
        assert_eq!(running.line(), "ready dds 127.0.0.1");
        (running, person)
    }
}

fn object(line: &str) -> Value {
    serde_json::from_str(line).unwrap_or_else(|_| panic!("{line}"))
}

/// A round of commands and states, as both ends tell it: until the hand was stopped because theirs fell silent. Gives the commands
/// that were followed since ours began.
fn round(ours: &mut Running, theirs: &mut Running) -> f64 {
    let first = object(&theirs.line());
    let sent = object(&theirs.line());
    ours.until(|line| object(line)["phase"] == "following");
    let ended = object(&ours.until(|line| object(line)["phase"] == "waiting"));
    println!("{first} {sent} {ended}");
    assert_eq!(sent["sent"], COMMANDS);
    let (heard, told) = (&sent["states"], &sent["told"]);
    assert!(
        heard.as_f64().unwrap() >= ARRIVE * told.as_f64().unwrap(),
        "{sent}"
    );
    assert_eq!(ended["lost"], 0, "{ended}");
    assert_eq!(ended["refused"], serde_json::json!({}), "{ended}");
    // The last one asks for 502, and the hand was on its way.
    let index = sent["angle_act"][3].as_i64().unwrap();
    assert!((490..700).contains(&index), "{sent}");
    followed(&ended)
}

fn followed(told: &Value) -> f64 {
    told["taken"].as_f64().unwrap() - told["not_granted"].as_f64().unwrap()
}

#[test]
fn unitrees_own_stack_reads_and_moves_the_hand_also_after_either_side_was_killed() {
    unless_busy(|| {
        let Some(meeting) = Meeting::new() else {
            return skipped("cyclonedds", "no Python here has CycloneDDS 0.10.2");
        };
        let (mut ours, mut person) = meeting.follow();
        let mut theirs = meeting.unitree(COMMANDS, 1);
        let once = round(&mut ours, &mut theirs);
        theirs.end().ok();
        let all = COMMANDS as f64;
        assert!(once >= ARRIVE * all, "{once}");
        let stopped = "fell silent: the hand was stopped";
        assert!(ours.complaint().contains(stopped));
        // Theirs is killed in the middle, and the hand is stopped until a person lets it go on.
        person.write_all(b"\n").unwrap();
        let mut theirs = meeting.unitree(100_000, 1);
        theirs.line();
        ours.until(|line| object(line)["phase"] == "following");
        theirs.kill();
        let before = followed(&object(
            &ours.until(|line| object(line)["phase"] == "waiting"),
        ));
        assert!(ours.complaint().contains(stopped));
        person.write_all(b"\n").unwrap();
        let mut theirs = meeting.unitree(COMMANDS, 2);
        let again = round(&mut ours, &mut theirs) - before;
        assert!(again >= ARRIVE * all, "{again}");
        // Ours is killed; theirs goes on and meets the next.
        ours.kill();
        // Long enough for theirs to see that nobody tells states.
        std::thread::sleep(Duration::from_secs(1));
        let (mut ours, _person) = meeting.follow();
        let last = round(&mut ours, &mut theirs);
        theirs.end().ok();
        assert!(last >= ARRIVE * all, "{last}");
        println!("followed {once}, {again}, {last} of {all}");
    });
}

#[test]
fn programs_of_ros_2_see_the_frames_and_move_and_stop_the_hand() {
    unless_busy(|| {
        let Some(meeting) = Meeting::new() else {
            return skipped("cyclonedds", "no Python here has CycloneDDS 0.10.2");
        };
        let (mut ours, mut person) = meeting.follow();
        let mut theirs = meeting.ros();
        let seen = object(&theirs.line());
        assert_eq!((&seen["frames"], &seen["fixed"]), (&12.into(), &5.into()));
        let by_trajectory = object(&theirs.line());
        // They fall silent, and a user lets them go on.
        ours.until(|line| object(line)["phase"] == "following");
        let ended = object(&ours.until(|line| object(line)["phase"] == "waiting"));
        let refused = serde_json::json!({ "points": 1, "timing": 1 });
        assert_eq!(ended["refused"], refused, "{ended}");
        // Only what is typed after the question counts.
        let question = ours.complaint();
        assert!(
            question.contains("fell silent: the hand was stopped"),
            "{question}"
        );
        person.write_all(b"\n").unwrap();
        let by_positions = object(&theirs.line());
        println!("{seen} {by_trajectory} {by_positions}");
        ours.until(|line| object(line)["phase"] == "following");
        assert_eq!(object(&theirs.line())["stopped"], true);
        let stopped = object(&ours.until(|line| object(line)["phase"] == "waiting"));
        assert_eq!(stopped["refused"], refused, "{stopped}");
        theirs.end().ok();
    });
}
